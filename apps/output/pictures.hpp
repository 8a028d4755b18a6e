// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/recorded_truth.hpp"
#include "options/report_options.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {

/// Writes ranges, wrap counts, jump probabilities and clouds of a few frames, spread evenly over
/// the recording, as `<frame>_<what>.png`. Damaged frames have none. Throws Interrupted.
void write_frame_pictures(const std::filesystem::path& folder, const SequenceReader& source,
                          const UnwrapOptions& unwrap, const PictureOptions& options, bool quiet);

/// Writes what every method makes of a few frames, as `<frame>_methods.png`, and what filters
/// remove of it without unwrapping and after it, by the last method, as `<frame>_filters.png`.
/// Throws Interrupted.
void write_method_pictures(const std::filesystem::path& folder, const SequenceReader& source,
                           const RecordedTruth& recorded, const std::vector<std::string>& methods,
                           UnwrapOptions unwrap, const FilterOptions& filters,
                           const PictureOptions& options, bool quiet);

/// Writes the map from above and from inside, as map_above.png and map_inside.png.
void write_map_pictures(const std::filesystem::path& folder, const MapCloud& map,
                        const Trajectory& trajectory, const PictureOptions& options);

/// Draws into the folder `pictures` of a result that is in place already, so that nothing is lost
/// if this fails. The folder appears when all pictures are there. Where there is nothing to draw
/// with, says so on stderr and goes on; throws InputError if pictures cannot be written. What
/// `draw` throws passes, and leaves no picture.
void add_pictures(const std::filesystem::path& result,
                  const std::function<void(const std::filesystem::path& folder)>& draw);

}  // namespace tofmap::app
