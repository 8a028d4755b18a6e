// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runs/unwrapped_frame.hpp"

#include "output/frame_report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/filters/gates.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

/// 16-bit millimetres, 0 = invalid.
ImageU16 range_mm(const RangeImage& image, const std::string& name) {
  ImageU16 out = ImageU16::Zero(image.rows(), image.cols());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (image.reason.data()[i] != 0) continue;
    const double mm = std::round(1000.0 * image.range_m.data()[i]);
    if (mm > 65535) {
      throw InputError(name + ": a range of " + std::to_string(mm / 1000) +
                       " m does not fit the 65.535 m of a range image; set unwrap.max_range_m");
    }
    // A valid range is never written as 0, which would mean invalid.
    out.data()[i] = static_cast<std::uint16_t>(std::max(1.0, mm));
  }
  return out;
}

ImageU16 confidence_u16(const ImageF& confidence) {
  return (confidence.max(0).min(1) * 65535.0F).round().cast<std::uint16_t>();
}

}  // namespace

UnwrappedFrame unwrap_frame(const SequenceReader& source, int index, Unwrapper& unwrapper,
                            const PixelRays& rays, const UnwrappedFrameOptions& options) {
  const SourcedFrame sourced = source.read(index);
  UnwrappedFrame out;
  out.timestamp_s = sourced.timestamp_s;
  out.name = source.files()[static_cast<std::size_t>(index)].phase_a.filename();
  if (!sourced.frame) {
    out.damage = sourced.damage;
    out.report = damaged_json(sourced);
    return out;
  }
  const auto start = std::chrono::steady_clock::now();
  const UnwrapResult result = unwrapper.unwrap(*sourced.frame);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  out.image = drop_low_confidence(result.image, options.min_confidence);
  out.report = {{"index", index},
                {"timestamp", sourced.timestamp_s},
                {"milliseconds", spent.count()},
                {"iterations", result.iterations},
                {"converged", result.converged},
                {"curl_violations", result.curl_violations},
                {"largest_message_change", result.largest_message_change},
                {"phase_noise_cycles", result.phase_noise_cycles},
                {"regions", result.regions},
                {"ambiguous_pixels", count_reason(result.image, InvalidReason::ambiguous)},
                {"saturated_pixels", count_reason(result.image, InvalidReason::saturated)},
                {"valid_pixels", out.image.count_valid()}};
  if (options.with_filters) {
    FilterResult filtered =
        apply_filters(out.image, *sourced.frame, source.sensor().modulation, rays, options.filters);
    out.image = std::move(filtered.image);
    add_filter_counts(out.report, filtered.counts);
  }
  return out;
}

void write_images(const std::filesystem::path& out, const UnwrappedFrame& frame) {
  write_png(out / "range" / frame.name, range_mm(frame.image, frame.name.string()));
  write_png(out / "wraps" / frame.name, frame.image.wrap_count);
  write_png(out / "confidence" / frame.name, confidence_u16(frame.image.confidence));
  write_png(out / "reason" / frame.name, frame.image.reason);
}

Json unwrapping_summary(const Json& frames, int damaged, bool interrupted) {
  double milliseconds = 0;
  double iterations = 0;
  int converged = 0;
  int read = 0;
  for (const Json& frame : frames) {
    if (frame.contains("damage")) continue;
    ++read;
    milliseconds += frame["milliseconds"].get<double>();
    iterations += frame["iterations"].get<double>();
    converged += frame["converged"].get<bool>() ? 1 : 0;
  }
  const double count = std::max(1, read);
  return {{"frames", frames.size()},
          {"damaged", damaged},
          {"interrupted", interrupted},
          {"converged", converged},
          {"milliseconds_per_frame", milliseconds / count},
          {"iterations_per_frame", iterations / count}};
}

}  // namespace tofmap::app
