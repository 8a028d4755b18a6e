// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// OpenNI2's header uses these two macros without defining them.
#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
