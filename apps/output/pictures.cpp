// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/pictures.hpp"

#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "output/result_addition.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/evaluation/range_score.hpp>
#include <tofmap/unwrap/jump/jump_estimate.hpp>
#include <tofmap/visualization/cloud_pictures.hpp>
#include <tofmap/visualization/drawing.hpp>
#include <tofmap/visualization/frame_pictures.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

/// The jump probabilities by each term alone, fused, and after propagation. They sum to one in each
/// of these stages.
Picture jump_stages_picture(const Frame& recorded, const SensorModel& sensor,
                            const UnwrapOptions& options) {
  const JumpMethod method = jump_method(options.method);
  const ComparedPair pair = compared_pair(options, sensor.modulation);
  // `single` has no second frequency.
  const std::size_t b = pair.b.value_or(pair.a);
  const Frame frame = with_frequencies(recorded, {pair.a, b});
  JumpEstimator estimator;
  const JumpEstimate& jumps = estimator.estimate(
      frame, PhaseSigma(frame, estimate_phase_noise(frame)),
      pair_limits({pair.a, b}, sensor.modulation, unwrap_limits(sensor, options.max_range_m)),
      method, options);
  const JumpInputs& inputs = jumps.inputs;
  const auto evidence = [&](double trust_discontinuity, double trust_frequency) {
    JumpTerms terms = inputs.terms;
    terms.trust_discontinuity = trust_discontinuity;
    terms.trust_frequency = trust_frequency;
    JumpProbabilities out;
    find_jump_evidence(frame.phases[0], inputs.noise_cycles, inputs.reconstruction_cycles, terms,
                       out);
    return out;
  };
  const JumpProbabilities by_discontinuity = evidence(1, 0);
  std::vector<JumpStage> stages{
      {"discontinuity term f_d", &by_discontinuity.x, &by_discontinuity.y}};
  JumpProbabilities by_frequency;
  if (method.has_frequency_term) {
    by_frequency = evidence(0, 1);
    stages.push_back({"frequency term f_f", &by_frequency.x, &by_frequency.y});
    stages.push_back({"fused", &jumps.evidence.x, &jumps.evidence.y});
  }
  stages.push_back({"after propagation", &jumps.beliefs.marginals.x, &jumps.beliefs.marginals.y});
  return jump_picture(stages);
}

void write_pictures_of(const PicturedFrame& frame, const SensorModel& sensor, const PixelRays& rays,
                       const UnwrapOptions& options, const std::filesystem::path& folder) {
  const RangeImage& unwrapped = *frame.unwrapped;
  const auto wavelength_m = static_cast<float>(sensor.modulation.wavelength_m(0));
  const ImageF wrapped_m =
      (unwrapped.reason == 0).select(frame.recorded->phases[0] * wavelength_m, NAN);
  const auto write = [&](const char* what, const Picture& picture) {
    write_picture(folder / (frame.stem + "_" + what + ".png"), picture);
  };
  write("range", range_picture(wrapped_m, unwrapped.range_m));
  write("wraps", wrap_count_picture(unwrapped.wrap_count));
  write("confidence", confidence_picture(unwrapped));
  if (finds_jumps(options.method)) {
    write("jumps", jump_stages_picture(*frame.recorded, sensor, options));
  }
  write("cloud", cloud_picture(unwrapped, wrapped_m, rays));
}

/// The name of the method and, if the truth is known, the percentage of wrong wraps.
std::string method_title(const std::string& method, const RangeImage& image,
                         const std::optional<ImageF>& truth_m, double wavelength_m) {
  if (!truth_m) return method;
  char title[80];
  std::snprintf(title, sizeof title, "%s: %.1f %% wrong", method.c_str(),
                score_ranges(image, *truth_m, wavelength_m).wrong_wrap_percent);
  return title;
}

/// The ranges of a method before filters, the reasons after filters, and a title with the
/// percentage removed.
FilteredRanges filtered_ranges(UnwrapMethod method, const RangeImage& before,
                               const RangeImage& after) {
  const int valid = before.count_valid();
  const double removed = valid > 0 ? 100.0 * (valid - after.count_valid()) / valid : 0;
  const std::string_view name =
      method == UnwrapMethod::none ? std::string_view("without unwrapping") : name_of(method);
  return {fmt::format("{}: filters remove {:.1f} %", name, removed), before.range_m, after.reason};
}

std::string stem_of(const SampledFrame& frame) {
  return fmt::format("{:06}", frame.recorded.index);
}

/// The frame of this index in the sample of each result. Null where a sample does not have it.
std::vector<const SampledFrame*> frame_of_all(const std::vector<MethodResult>& results, int index) {
  std::vector<const SampledFrame*> frames;
  for (const MethodResult& result : results) {
    const auto found = std::ranges::find_if(
        result.sample, [&](const SampledFrame& frame) { return frame.recorded.index == index; });
    frames.push_back(found == result.sample.end() ? nullptr : &*found);
  }
  return frames;
}

/// The frame with method `none`, which does not unwrap, and filters.
PreparedFrame wrapped_frame(const Frame& frame, const SensorModel& sensor, const PixelRays& rays,
                            PipelineOptions pipeline) {
  pipeline.unwrap.method = UnwrapMethod::none;
  FrameMeasurer measurer(sensor, pipeline.unwrap);
  Unwrapper unwrapper(sensor, pipeline.unwrap);
  return prepare_ranges(measure_frame(frame, measurer), unwrapper, sensor, rays, pipeline);
}

}  // namespace

std::vector<PicturedFrame> pictured_frames(const std::vector<SampledFrame>& sample,
                                           const PictureOptions& options) {
  std::vector<PicturedFrame> frames;
  for (const int i : spread_indices(static_cast<int>(sample.size()), options.frames)) {
    const SampledFrame& frame = sample[static_cast<std::size_t>(i)];
    frames.push_back({stem_of(frame), &frame.recorded, &frame.unwrapped.image});
  }
  return frames;
}

void write_frame_pictures(const std::filesystem::path& folder,
                          const std::vector<PicturedFrame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& unwrap, bool quiet) {
  const PixelRays rays = pixel_rays(sensor.camera);
  Progress progress("drawing frame", static_cast<int>(frames.size()), quiet);
  int done = 0;
  for (const PicturedFrame& frame : frames) {
    stop_if_interrupted();
    progress.show(done++);
    write_pictures_of(frame, sensor, rays, unwrap, folder);
  }
}

void write_method_pictures(const std::filesystem::path& folder,
                           const std::vector<MethodResult>& results, const RecordedTruth& recorded,
                           const SensorModel& sensor, const PipelineOptions& pipeline,
                           const PictureOptions& options, bool quiet) {
  const PixelRays rays = pixel_rays(sensor.camera);
  const double wavelength_m = sensor.modulation.wavelength_m(0);
  const std::vector<SampledFrame>& sample = results.back().sample;
  const std::vector<int> chosen = spread_indices(static_cast<int>(sample.size()), options.frames);
  Progress progress("drawing methods, frame", static_cast<int>(chosen.size()), quiet);
  int done = 0;
  for (const int i : chosen) {
    stop_if_interrupted();
    progress.show(done++);
    const SampledFrame& last = sample[static_cast<std::size_t>(i)];
    const std::optional<ImageF> truth_m = recorded.range_m(last.recorded.index);
    const std::vector<const SampledFrame*> frames = frame_of_all(results, last.recorded.index);
    std::vector<MethodRanges> ranges;
    for (std::size_t m = 0; m < frames.size(); ++m) {
      if (!frames[m]) continue;
      const RangeImage& image = frames[m]->unwrapped.image;
      ranges.push_back(
          {method_title(results[m].name, image, truth_m, wavelength_m), image.range_m});
    }
    write_picture(folder / (stem_of(last) + "_methods.png"),
                  method_picture(ranges, truth_m.value_or(ImageF()), wavelength_m));
    const PreparedFrame wrapped = wrapped_frame(last.recorded, sensor, rays, pipeline);
    const std::vector<FilteredRanges> filtered{
        filtered_ranges(UnwrapMethod::none, wrapped.unwrapped.image, wrapped.filtered.image),
        filtered_ranges(results.back().method, last.unwrapped.image, last.filtered)};
    write_picture(folder / (stem_of(last) + "_filters.png"), filter_picture(filtered));
  }
}

void write_map_pictures(const std::filesystem::path& folder, const MapCloud& map,
                        const Trajectory& trajectory, const PictureOptions& options) {
  const GravityAlignedFrame frame = gravity_aligned_frame(map, trajectory);
  write_picture(folder / "map_above.png",
                map_from_above(map, trajectory, frame, options.map_size_px));
  write_picture(folder / "map_inside.png",
                map_from_inside(map, trajectory, frame, options.map_size_px));
}

void add_pictures(const std::filesystem::path& result,
                  const std::function<void(const std::filesystem::path& folder)>& draw) {
  try {
    ResultAddition pictures(result, "pictures");
    std::error_code error;
    std::filesystem::create_directory(pictures.path(), error);
    if (error) throw InputError(pictures.path().string() + ": cannot be created");
    draw(pictures.path());
    pictures.commit();
  } catch (const DrawingError& error) {
    std::fprintf(stderr, "tofmap: no pictures: %s\n", error.what());
  }
}

}  // namespace tofmap::app
