// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "levelled_cloud.hpp"

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

/// Registers one cloud with another without an initial pose. The pose of the result is between the
/// centred frames of both clouds (LevelledCloud::centre_m). The indices `source` and `target` of
/// the result are 0.
CloudPair align_pair(const LevelledCloud& source, const LevelledCloud& target,
                     const CloudRegistrationOptions& options);

}  // namespace tofmap
