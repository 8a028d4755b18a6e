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

/// A frame to be drawn, with its unwrapped ranges. Both images must outlive this.
struct PicturedFrame {
  std::string stem;  ///< first part of the file names of its pictures
  const Frame* recorded = nullptr;
  const RangeImage* unwrapped = nullptr;
};

/// At most options.frames of the sampled frames, spread evenly. Their stem is their index.
std::vector<PicturedFrame> pictured_frames(const std::vector<SampledFrame>& sample,
                                           const PictureOptions& options);

/// Writes pictures of the ranges, wrap counts, confidence, jump probabilities (of methods that
/// estimate them) and clouds of frames, as `<stem>_<what>.png`. Throws Interrupted.
void write_frame_pictures(const std::filesystem::path& folder,
                          const std::vector<PicturedFrame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& unwrap, bool quiet);

/// Writes pictures that compare the methods on at most options.frames frames of the last result's
/// sample: the ranges of each method as `<frame>_methods.png`, and the pixels that filters remove,
/// without unwrapping and after the last method, as `<frame>_filters.png`. `results` must not be
/// empty. Throws Interrupted.
void write_method_pictures(const std::filesystem::path& folder,
                           const std::vector<MethodResult>& results, const RecordedTruth& recorded,
                           const SensorModel& sensor, const PipelineOptions& pipeline,
                           const PictureOptions& options, bool quiet);

/// Writes pictures of the map from above and from inside, as map_above.png and map_inside.png.
void write_map_pictures(const std::filesystem::path& folder, const MapCloud& map,
                        const Trajectory& trajectory, const PictureOptions& options);

/// Adds the folder `pictures` to a result that is already in place. `draw` writes the pictures into
/// a temporary folder, which is moved into the result when all are done. A DrawingError is printed
/// on stderr and leaves the result without pictures; other exceptions of `draw` are passed on.
/// Throws InputError if the pictures cannot be written.
void add_pictures(const std::filesystem::path& result,
                  const std::function<void(const std::filesystem::path& folder)>& draw);

}  // namespace tofmap::app
