// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/error_survey.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

#include <tofmap/core/bytes.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// Smaller errors are not reported. The errors of calibrated cameras stay below these limits:
/// camera motion and multipath alone cause some millimetres of each.
constexpr double least_offset_m = 0.01;
constexpr double least_periodic_m = 0.008;
constexpr double least_per_decade_m = 0.005;
constexpr double least_systematic_m = 0.015;
constexpr double least_flow_px = 1.5;
constexpr double least_ambient_share = 0.03;

double millimetres(double metres) { return 1000 * metres; }

}  // namespace

void ErrorTally::add(const MeasuredFrame& frame) {
  cameras_.clear();
  double flow_px = 0;
  int pixels = 0;
  for (const FrameErrors& errors : frame.errors) {
    cameras_.push_back(errors.camera);
    flow_px = std::max(flow_px, errors.flow_px);
    pixels = std::max(pixels, errors.pixels);
  }
  if (pixels > 0) {
    ++frames_;
    // No camera turns by a quarter of its view between two exposures: images do not belong
    // together.
    const double most_flow_px = 0.25 * static_cast<double>(frame.returns.cols());
    if (flow_px < most_flow_px) flows_px_.push_back(static_cast<float>(flow_px));
  }
  pixels_ += static_cast<double>((frame.valid != 0).count());
  has_amplitudes_ = frame.returns.has_amplitude();
  constexpr float raised = 1.4F;
  for (Eigen::Index i = 0; i < frame.ambient.size(); ++i) {
    if (frame.valid.data()[i] == 0 || frame.ambient.data()[i] < raised) continue;
    ambient_pixels_ += 1;
    ambient_factors_ += frame.ambient.data()[i];
  }
}

void ErrorTally::save(ByteWriter& out) const {
  out.number(static_cast<std::uint32_t>(cameras_.size()));
  for (const CameraErrors& camera : cameras_) tofmap::save(camera, out);
  out.number(frames_);
  out.number(static_cast<std::uint32_t>(flows_px_.size()));
  for (const float flow_px : flows_px_) out.number(flow_px);
  out.number(pixels_);
  out.number(ambient_pixels_);
  out.number(ambient_factors_);
  out.number<std::uint8_t>(has_amplitudes_ ? 1 : 0);
}

void ErrorTally::load(ByteReader& in) {
  constexpr std::uint32_t most_cameras = most_frequencies;
  constexpr int most_frames = std::numeric_limits<int>::max();
  cameras_.clear();
  const auto cameras = in.number<std::uint32_t>(0, most_cameras);
  for (std::uint32_t i = 0; i < cameras; ++i) cameras_.push_back(camera_errors_in(in));
  frames_ = in.number(0, most_frames);
  flows_px_.clear();
  const auto flows = in.number<std::uint32_t>(0, static_cast<std::uint32_t>(frames_));
  for (std::uint32_t i = 0; i < flows; ++i) flows_px_.push_back(in.number<float>());
  pixels_ = in.number<double>();
  ambient_pixels_ = in.number<double>();
  ambient_factors_ = in.number<double>();
  has_amplitudes_ = in.number<std::uint8_t>(0, 1) != 0;
}

ErrorSurvey ErrorTally::survey() const {
  ErrorSurvey survey;
  survey.cameras = cameras_;
  survey.has_amplitudes = has_amplitudes_;
  survey.frames = frames_;
  std::vector<float> flows_px = flows_px_;
  if (!flows_px.empty()) survey.flow_px = median(flows_px);
  if (pixels_ > 0) survey.ambient_share = ambient_pixels_ / pixels_;
  if (ambient_pixels_ > 0) survey.ambient_factor = ambient_factors_ / ambient_pixels_;
  return survey;
}

ErrorSurvey survey_errors(const std::vector<Frame>& frames, const SensorModel& sensor,
                          const UnwrapOptions& options) {
  FrameMeasurer measurer(sensor, options);
  ErrorTally tally;
  for (const Frame& frame : frames) tally.add(measurer.measure(frame));
  return tally.survey();
}

std::vector<std::string> remarks_about(const ErrorSurvey& survey) {
  std::vector<std::string> remarks;
  for (std::size_t f = 1; f < survey.cameras.size(); ++f) {
    const CameraErrors& camera = survey.cameras[f];
    const std::string b = frequency_name(f);
    if (camera.frames == 0) continue;
    if (std::abs(camera.offset_m()) >= least_offset_m) {
      remarks.push_back(fmt::format(
          "offset between the frequencies: A measures {:.0f} mm {} than {}; unwrapping compensates "
          "for it, but ranges keep the error of A or {}: 'tofmap calibrate' with known ranges "
          "finds "
          "out which",
          millimetres(std::abs(camera.offset_m())), camera.offset_m() < 0 ? "less" : "more", b, b));
    }
    if (camera.periodic_rms_m >= least_periodic_m) {
      remarks.push_back(fmt::format(
          "the ranges of A and {} differ by a periodic error of {:.0f} mm (RMS); unwrapping "
          "compensates for it, but ranges keep it: 'tofmap calibrate' finds and corrects it",
          b, millimetres(camera.periodic_rms_m)));
    }
    const double per_decade_m = camera.per_decade_m();
    if (std::abs(per_decade_m) >= least_per_decade_m) {
      remarks.push_back(fmt::format(
          "A measures {:.0f} mm {} than {} for every factor of ten in amplitude; unwrapping "
          "compensates for it",
          millimetres(std::abs(per_decade_m)), per_decade_m < 0 ? "less" : "more", b));
    }
    if (camera.systematic_m >= least_systematic_m) {
      remarks.push_back(fmt::format(
          "the ranges of A and {} differ by {:.0f} mm (RMS) beyond noise, offset and periodic "
          "errors; unwrapping gives them less confidence",
          b, millimetres(camera.systematic_m)));
    }
  }
  if (survey.flow_px >= least_flow_px) {
    remarks.push_back(fmt::format(
        "the image moves by {:.1f} pixels (median) from the first exposure of a frame to the last; "
        "unwrapping moves pixels back to where A saw them",
        survey.flow_px));
  }
  if (survey.ambient_share >= least_ambient_share) {
    const char* compared = survey.has_amplitudes
                               ? "as their amplitudes predict, as under ambient light"
                               : "as the others";
    remarks.push_back(fmt::format(
        "{:.0f} % of the pixels are at least {:.1f} times as noisy {}; unwrapping gives "
        "them less weight",
        100 * survey.ambient_share, survey.ambient_factor, compared));
  }
  return remarks;
}

std::vector<std::string> warnings_about(const ErrorSurvey& survey, bool map_agrees) {
  // A periodic error of 1 cm made trajectories ten times worse (docs/mapping.md). If that did not
  // make frames disagree, the map has the error itself, of which a wall may have twice as much.
  const double most_periodic_m = map_agrees ? 0.025 : 0.01;
  double periodic_m = 0;
  for (const CameraErrors& camera : survey.cameras) {
    if (camera.frames > 0) periodic_m = std::max(periodic_m, camera.periodic_rms_m);
  }
  if (periodic_m < most_periodic_m) return {};
  return {fmt::format(
      "ranges have a periodic error of about {:.0f} mm, and the error of the map is at least as "
      "large; 'tofmap calibrate' finds and corrects it. If a calibration is in use already, it "
      "does "
      "not fit this recording",
      millimetres(periodic_m))};
}

}  // namespace tofmap
