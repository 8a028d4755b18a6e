// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/acquisition/correlation/correlation_description.hpp>

namespace tofmap {

/// The times of a list or a text file, in seconds. Empty if the times follow from a rate. Throws
/// InputError, which names file and line, if the file cannot be read, a line has no number in the
/// column, or a time is not later than the one before it.
std::vector<double> listed_times_s(const FrameTimes& times, const std::filesystem::path& origin);

/// The time of a frame whose number differs by `number` from that of the first frame, from the
/// rate.
double regular_time_s(const FrameTimes& times, std::int64_t number);

}  // namespace tofmap
