// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <vector>

#include <tofmap/mapping/odometry.hpp>

namespace tofmap {

/// Writes results of tracking, exact to the bit. Only the same build can read them again.
void save_tracking(const std::vector<TrackingResult>& results, std::ostream& out);

/// Reads what save_tracking() wrote. Throws boost::archive::archive_exception if the stream holds
/// something else or ends early.
std::vector<TrackingResult> load_tracking(std::istream& in);

}  // namespace tofmap
