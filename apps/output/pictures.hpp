// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/report_options.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/evaluation/method_run.hpp>
#include <tofmap/pipeline/frame_sample.hpp>

namespace tofmap::app {

/// A frame to be drawn, with what unwrapping made of it. Both must outlive this.
struct PicturedFrame {
  std::string stem;  ///< of the names of its pictures
  const DualFrequencyFrame* recorded = nullptr;
  const RangeImage* unwrapped = nullptr;
};

/// At most options.frames of the sampled frames, spread evenly, named by their index.
std::vector<PicturedFrame> pictured_frames(const std::vector<SampledFrame>& sample,
                                           const PictureOptions& options);

/// Writes ranges, wrap counts, confidence, jump probabilities and clouds of frames, as
/// `<stem>_<what>.png`. Throws Interrupted.
void write_frame_pictures(const std::filesystem::path& folder,
                          const std::vector<PicturedFrame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& unwrap, bool quiet);

/// Writes what every method makes of the frames that all results have in their samples, at most
/// options.frames, as `<frame>_methods.png`; and what filters remove without unwrapping and after
/// the last method, as `<frame>_filters.png`. `results` is not empty. Throws Interrupted.
void write_method_pictures(const std::filesystem::path& folder,
                           const std::vector<MethodResult>& results, const RecordedTruth& recorded,
                           const SensorModel& sensor, const PipelineOptions& pipeline,
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
