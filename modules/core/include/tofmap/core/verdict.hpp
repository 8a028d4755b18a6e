// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tofmap {

/// How far a result can be trusted, from best to worst.
enum class Verdict { good, check, bad };

}  // namespace tofmap
