// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/unwrapped_frame.hpp"

#include "output/frame_report.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/timed.hpp>
#include <tofmap/filters/gates.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

/// A range in whole millimetres, the unit of range images.
double millimetres(float range_m) { return std::round(1000.0 * range_m); }

/// Ranges as 16-bit millimetres, 0 for invalid pixels. Valid ranges must fit (drop_out_of_range).
ImageU16 range_mm(const RangeImage& image) {
  ImageU16 out = ImageU16::Zero(image.rows(), image.cols());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (image.reason.data()[i] != 0) continue;
    out.data()[i] = static_cast<std::uint16_t>(millimetres(image.range_m.data()[i]));
  }
  return out;
}

ImageU16 confidence_u16(const ImageF& confidence) {
  return (confidence.max(0).min(1) * 65535.0F).round().cast<std::uint16_t>();
}

}  // namespace

UnwrappedFrame unwrap_frame(const MeasuredSource& source, const Modulation& modulation,
                            Unwrapper& unwrapper, const PixelRays& rays,
                            const UnwrappedFrameOptions& options) {
  const SourcedFrame& sourced = source.sourced;
  UnwrappedFrame out;
  out.timestamp_s = sourced.timestamp_s;
  if (!source.measured) {
    out.damage = sourced.damage;
    out.report = damaged_json(sourced);
    return out;
  }
  double milliseconds = source.measured->milliseconds;
  const UnwrapResult result =
      timed(milliseconds, [&] { return unwrapper.unwrap(source.measured->frame); });
  if (options.keep_unfiltered) out.unfiltered = result.image;
  out.image = drop_low_confidence(result.image, options.min_confidence);
  out.out_of_range = drop_out_of_range(out.image);
  const FrameErrors second = result.errors.size() > 1 ? result.errors[1] : FrameErrors();
  out.report = {{"index", sourced.index},
                {"timestamp", sourced.timestamp_s},
                {"milliseconds", milliseconds},
                {"iterations", result.iterations},
                {"converged", result.converged ? Json(*result.converged) : Json(nullptr)},
                {"curl_violations", result.curl_violations},
                {"phase_noise_cycles", result.phase_noise_cycles},
                {"frequency_offset_m", second.camera.offset_m()},
                {"systematic_m", second.camera.systematic_m},
                {"exposure_flow_px", second.flow_px},
                {"regions", result.regions},
                {"ambiguous_pixels", count_reason(result.image, InvalidReason::ambiguous)},
                {"saturated_pixels", count_reason(result.image, InvalidReason::saturated)},
                {"valid_pixels", out.image.count_valid()}};
  if (options.with_filters) {
    FilterResult filtered =
        apply_filters(out.image, source.measured->frame.returns, modulation, rays, options.filters);
    out.image = std::move(filtered.image);
    add_filter_counts(out.report, filtered.counts);
  }
  return out;
}

int drop_out_of_range(RangeImage& image) {
  constexpr double least_mm = 1;
  constexpr double most_mm = 65535;
  int dropped = 0;
  for (Eigen::Index v = 0; v < image.rows(); ++v) {
    for (Eigen::Index u = 0; u < image.cols(); ++u) {
      if (!image.valid(v, u)) continue;
      const double mm = millimetres(image.range_m(v, u));
      if (mm >= least_mm && mm <= most_mm) continue;  // false for NaN
      image.invalidate(v, u, InvalidReason::out_of_range);
      ++dropped;
    }
  }
  return dropped;
}

void add_fusion_counts(UnwrappedFrame& frame, int views) {
  frame.report["fused_views"] = views;
  frame.report["free_space_violation_pixels"] =
      count_reason(frame.image, InvalidReason::free_space_violation);
}

void finish_frame(UnwrappedFrame& frame) {
  if (!frame.damage.empty()) return;
  frame.out_of_range += drop_out_of_range(frame.image);
  frame.report["out_of_range_pixels"] = frame.out_of_range;
}

void write_images(const std::filesystem::path& out, const UnwrappedFrame& frame) {
  write_png(out / "range" / frame.name, range_mm(frame.image));
  write_png(out / "wraps" / frame.name, frame.image.wrap_count);
  write_png(out / "confidence" / frame.name, confidence_u16(frame.image.confidence));
  write_png(out / "reason" / frame.name, frame.image.reason);
}

Json unwrapping_summary(const Json& frames, int damaged, bool interrupted) {
  double milliseconds = 0;
  double iterations = 0;
  int converged = 0;
  bool can_converge = false;
  int read = 0;
  int out_of_range = 0;
  for (const Json& frame : frames) {
    if (frame.contains("damage")) continue;
    ++read;
    milliseconds += frame["milliseconds"].get<double>();
    iterations += frame["iterations"].get<double>();
    converged += frame["converged"] == true ? 1 : 0;
    can_converge = can_converge || frame["converged"].is_boolean();
    out_of_range += frame.value("out_of_range_pixels", 0);
  }
  const double count = std::max(1, read);
  return {{"frames", frames.size()},
          {"damaged", damaged},
          {"interrupted", interrupted},
          {"converged", can_converge ? Json(converged) : Json(nullptr)},
          {"out_of_range_pixels", out_of_range},
          {"milliseconds_per_frame", milliseconds / count},
          {"iterations_per_frame", iterations / count}};
}

}  // namespace tofmap::app
