// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/frame_strip.hpp"

#include "frame_colors.hpp"
#include "picture_gap.hpp"
#include "quantile.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

constexpr int legend_height_px = 220;

/// The colour scales of all frames, and the wrap counts and reasons that occur in any of them.
struct Scales {
  ColorScale range{0, 1, "range, m"};
  ColorScale amplitude{0, 1, "amplitude"};
  ColorScale confidence{0, 1, "confidence"};
  std::set<int> counts;
  std::set<InvalidReason> reasons;
  bool has_amplitude = false;
  bool has_truth = false;
};

/// Whether filters removed a pixel that was valid after unwrapping.
bool is_removed(const StagedFrame& frame, Eigen::Index v, Eigen::Index u) {
  return frame.unwrapped.valid(v, u) && !frame.filtered.valid(v, u);
}

Scales scales_of(const std::vector<StagedFrame>& frames) {
  Scales scales;
  double range_m = 1;
  double amplitude = 0;
  for (const StagedFrame& frame : frames) {
    const RangeImage& unwrapped = frame.unwrapped;
    range_m = std::max({range_m, round_limit_m(unwrapped.range_m), round_limit_m(frame.wrapped_m)});
    constexpr double brightest_left_out = 0.98;
    amplitude = std::max<double>(amplitude,
                                 finite_quantile(frame.amplitude, brightest_left_out).value_or(0));
    scales.has_amplitude |= frame.amplitude.size() > 0;
    scales.has_truth |= frame.truth_m.size() > 0;
    for (Eigen::Index v = 0; v < unwrapped.rows(); ++v) {
      for (Eigen::Index u = 0; u < unwrapped.cols(); ++u) {
        if (unwrapped.valid(v, u)) scales.counts.insert(unwrapped.wrap_count(v, u));
        if (is_removed(frame, v, u)) {
          scales.reasons.insert(static_cast<InvalidReason>(frame.filtered.reason(v, u)));
        }
      }
    }
  }
  scales.range = ColorScale(0, range_m, "range, m");
  // Amplitude falls with the square of the range, so that its root shows far surfaces as well.
  if (amplitude > 0) scales.amplitude = ColorScale(0, std::sqrt(amplitude), "root of amplitude");
  return scales;
}

void check(const StagedFrame& frame) {
  const ImageF& range_m = frame.unwrapped.range_m;
  const auto fits = [&](const ImageF& image) {
    return image.size() == 0 || same_size(image, range_m);
  };
  if (!fits(frame.amplitude) || !fits(frame.truth_m) || !same_size(frame.wrapped_m, range_m) ||
      !same_size(frame.filtered.range_m, range_m)) {
    throw UsageError("strip: images of '" + frame.title + "' differ in size");
  }
}

Picture removed_panel(const StagedFrame& frame, const Scales& scales) {
  const RangeImage& unwrapped = frame.unwrapped;
  return pixel_picture(unwrapped.rows(), unwrapped.cols(), [&](int v, int u) {
    if (!unwrapped.valid(v, u)) return colors::invalid;
    if (!is_removed(frame, v, u)) return scales.range(frame.filtered.range_m(v, u));
    return reason_color(static_cast<InvalidReason>(frame.filtered.reason(v, u)));
  });
}

std::vector<PageFigure> panels_of(const StagedFrame& frame, const Scales& scales,
                                  double wavelength_m) {
  const RangeImage& unwrapped = frame.unwrapped;
  std::vector<PageFigure> panels;
  const auto add = [&](const char* caption, const auto& color) {
    panels.push_back({pixel_picture(unwrapped.rows(), unwrapped.cols(), color), caption});
  };
  if (frame.amplitude.size() > 0) {
    add("amplitude",
        [&](int v, int u) { return scales.amplitude(std::sqrt(frame.amplitude(v, u))); });
  }
  add("wrapped range, as measured",
      [&](int v, int u) { return scales.range(frame.wrapped_m(v, u)); });
  add("wrap count", [&](int v, int u) {
    return unwrapped.valid(v, u) ? wrap_count_color(unwrapped.wrap_count(v, u)) : colors::invalid;
  });
  add("confidence of the wrap count", [&](int v, int u) {
    return unwrapped.valid(v, u) ? scales.confidence(unwrapped.confidence(v, u)) : colors::invalid;
  });
  add("unwrapped range", [&](int v, int u) { return scales.range(unwrapped.range_m(v, u)); });
  panels.push_back({removed_panel(frame, scales), "after filters, removed pixels by reason"});
  if (frame.truth_m.size() > 0) {
    add("wraps against the truth", [&](int v, int u) {
      return wrap_error_color(unwrapped.range_m(v, u), frame.truth_m(v, u), wavelength_m);
    });
  }
  return panels;
}

std::string remark_on(const StagedFrame& frame) {
  const int valid = frame.unwrapped.count_valid();
  const int wrapped =
      static_cast<int>((frame.unwrapped.reason == 0 && frame.unwrapped.wrap_count > 0).count());
  const int kept = frame.filtered.count_valid();
  const double whole = std::max(1, valid) / 100.0;
  return counted(static_cast<std::size_t>(valid), "pixel") +
         fmt::format(" with a range; unwrapping moved {:.1f} % of them, filters removed {:.1f} %.",
                     wrapped / whole, (valid - kept) / whole);
}

std::vector<PageFigure> legends_of(const Scales& scales) {
  std::vector<PageFigure> legends;
  legends.push_back({beside({color_bar(scales.range, legend_height_px),
                             color_key({{colors::invalid, "no range"}})},
                            picture_gap_px),
                     "ranges"});
  if (scales.has_amplitude) {
    legends.push_back({color_bar(scales.amplitude, legend_height_px), "amplitude"});
  }
  legends.push_back({color_bar(scales.confidence, legend_height_px), "confidence"});
  std::vector<LegendEntry> counts;
  for (const int count : scales.counts) {
    counts.push_back({wrap_count_color(count), std::to_string(count)});
  }
  if (!counts.empty()) legends.push_back({color_key(counts), "wrap counts"});
  std::vector<LegendEntry> reasons;
  for (const InvalidReason reason : scales.reasons) {
    reasons.push_back({reason_color(reason), reason_name(reason)});
  }
  if (!reasons.empty()) legends.push_back({color_key(reasons), "reasons for removal"});
  if (scales.has_truth) {
    legends.push_back({color_key({{wrap_errors::none, "right"},
                                  {wrap_errors::too_near, "too near"},
                                  {wrap_errors::too_far, "too far"}}),
                       "wraps against the truth"});
  }
  return legends;
}

}  // namespace

FrameStrip frame_strip(const std::vector<StagedFrame>& frames, double wavelength_m) {
  if (frames.empty()) return {};
  std::ranges::for_each(frames, check);
  const Scales scales = scales_of(frames);
  FrameStrip strip;
  for (const StagedFrame& frame : frames) {
    strip.frames.push_back({frame.title, panels_of(frame, scales, wavelength_m), remark_on(frame)});
  }
  strip.legends = legends_of(scales);
  return strip;
}

}  // namespace tofmap
