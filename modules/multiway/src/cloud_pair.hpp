// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "levelled_cloud.hpp"

#include <tofmap/multiway/cloud_registration.hpp>

namespace tofmap {

/// Lays one cloud onto another without knowing where. The pose is between the frames of their
/// levels; `source` and `target` of the result are left 0.
CloudPair align_pair(const LevelledCloud& source, const LevelledCloud& target,
                     const CloudRegistrationOptions& options);

}  // namespace tofmap
