// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/frame_pictures.hpp"

#include "frame_colors.hpp"
#include "picture_gap.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tofmap {
namespace {

/// A picture whose pixels have the colours `color(row, column)`, magnified by a whole number to
/// about `wanted_width_px`, or not at all if the image is larger.
template <class Color>
Picture image_picture(Eigen::Index rows, Eigen::Index cols, const Color& color,
                      Eigen::Index wanted_width_px = 530) {
  const Eigen::Index factor = wanted_width_px / std::max<Eigen::Index>(1, cols);
  return magnified(pixel_picture(rows, cols, color),
                   static_cast<int>(std::max<Eigen::Index>(1, factor)));
}

Picture jump_panel(const std::array<ImageF, 3>& planes) {
  return image_picture(planes[0].rows(), planes[0].cols(), [&](int v, int u) {
    return jump_color(planes[0](v, u), planes[1](v, u), planes[2](v, u));
  });
}

}  // namespace

Picture range_picture(const ImageF& wrapped_m, const ImageF& unwrapped_m) {
  const ColorScale scale(0, std::max(round_limit_m(wrapped_m), round_limit_m(unwrapped_m)),
                         "range, m");
  const auto panel = [&](const ImageF& range_m) {
    return image_picture(range_m.rows(), range_m.cols(),
                         [&](int v, int u) { return scale(range_m(v, u)); });
  };
  const Picture wrapped = titled(panel(wrapped_m), "wrapped");
  const Picture unwrapped = titled(panel(unwrapped_m), "unwrapped");
  const Picture legend = stacked({color_bar(scale, wrapped.height_px - 3 * picture_gap_px),
                                  color_key({{colors::invalid, "no range"}})},
                                 picture_gap_px);
  return with_margin(beside({wrapped, unwrapped, legend}, picture_gap_px), picture_gap_px);
}

Picture wrap_count_picture(const ImageU8& wrap_count) {
  std::set<int> occurring;
  const Picture panel = image_picture(wrap_count.rows(), wrap_count.cols(), [&](int v, int u) {
    const int count = wrap_count(v, u);
    if (count == invalid_wrap_count) return colors::invalid;
    occurring.insert(count);
    return wrap_count_color(count);
  });
  std::vector<LegendEntry> entries;
  for (const int count : occurring) {
    entries.push_back({wrap_count_color(count), std::to_string(count)});
  }
  entries.push_back({colors::invalid, "no range"});
  return with_margin(beside({titled(panel, "wrap count"), color_key(entries)}, picture_gap_px),
                     picture_gap_px);
}

Picture confidence_picture(const RangeImage& unwrapped) {
  const ColorScale scale(0, 1, "confidence");
  const Picture panel = titled(image_picture(unwrapped.rows(), unwrapped.cols(),
                                             [&](int v, int u) {
                                               return unwrapped.valid(v, u)
                                                          ? scale(unwrapped.confidence(v, u))
                                                          : colors::invalid;
                                             }),
                               "confidence of the wrap count");
  const Picture legend = stacked({color_bar(scale, panel.height_px - 3 * picture_gap_px),
                                  color_key({{colors::invalid, "no range"}})},
                                 picture_gap_px);
  return with_margin(beside({panel, legend}, picture_gap_px), picture_gap_px);
}

Picture method_picture(const std::vector<MethodRanges>& methods, const ImageF& truth_m,
                       double wavelength_m) {
  constexpr Eigen::Index panel_width_px = 352;  // several fit on a screen
  const bool has_truth = truth_m.size() > 0;
  double limit_m = has_truth ? round_limit_m(truth_m) : 1;
  if (!has_truth) {
    for (const MethodRanges& method : methods) {
      limit_m = std::max(limit_m, round_limit_m(method.range_m));
    }
  }
  const ColorScale scale(0, limit_m, "range, m");
  const auto range_panel = [&](const ImageF& range_m) {
    return image_picture(
        range_m.rows(), range_m.cols(), [&](int v, int u) { return scale(range_m(v, u)); },
        panel_width_px);
  };
  const auto error_panel = [&](const ImageF& range_m) {
    return image_picture(
        range_m.rows(), range_m.cols(),
        [&](int v, int u) { return wrap_error_color(range_m(v, u), truth_m(v, u), wavelength_m); },
        panel_width_px);
  };
  std::vector<Picture> columns;
  if (has_truth) {
    const Picture key = color_key({{wrap_errors::none, "right wrap count"},
                                   {wrap_errors::too_near, "too near, by one wrap or more"},
                                   {wrap_errors::too_far, "too far"},
                                   {colors::invalid, "above: no range"}});
    columns.push_back(stacked({titled(range_panel(truth_m), "truth"), key}, picture_gap_px));
  }
  for (const MethodRanges& method : methods) {
    std::vector<Picture> panels{titled(range_panel(method.range_m), method.title)};
    if (has_truth) panels.push_back(error_panel(method.range_m));
    columns.push_back(stacked(panels, picture_gap_px));
  }
  columns.push_back(color_bar(scale, columns.back().height_px / 2));
  return with_margin(beside(columns, picture_gap_px), picture_gap_px);
}

Picture filter_picture(const std::vector<FilteredRanges>& images) {
  double limit_m = 1;
  for (const FilteredRanges& image : images) {
    limit_m = std::max(limit_m, round_limit_m(image.range_m));
  }
  const ColorScale scale(0, limit_m, "range, m");
  std::set<InvalidReason> occurring;
  std::vector<Picture> columns;
  for (const FilteredRanges& image : images) {
    const Picture panel =
        image_picture(image.range_m.rows(), image.range_m.cols(), [&](int v, int u) {
          const auto reason = static_cast<InvalidReason>(image.reason(v, u));
          if (std::isnan(image.range_m(v, u))) return colors::invalid;
          if (reason == InvalidReason::none) return scale(image.range_m(v, u));
          occurring.insert(reason);
          return reason_color(reason);
        });
    columns.push_back(titled(panel, image.title));
  }
  std::vector<LegendEntry> entries;
  for (const InvalidReason reason : occurring) {
    entries.push_back({reason_color(reason), reason_name(reason)});
  }
  entries.push_back({colors::invalid, "no range"});
  columns.push_back(stacked({color_bar(scale, columns.front().height_px / 2), color_key(entries)},
                            picture_gap_px));
  return with_margin(beside(columns, picture_gap_px), picture_gap_px);
}

Picture jump_picture(const std::vector<JumpStage>& stages) {
  std::vector<Picture> rows;
  for (const JumpStage& stage : stages) {
    rows.push_back(beside({titled(jump_panel(*stage.x), stage.title + ", in x"),
                           titled(jump_panel(*stage.y), stage.title + ", in y")},
                          picture_gap_px));
  }
  const Picture key = color_key({{jump_color(1, 0, 0), "-1: one wrap more"},
                                 {jump_color(0, 1, 0), "0: no jump"},
                                 {jump_color(0, 0, 1), "+1: one wrap less"},
                                 {colors::invalid, "no node"}});
  return with_margin(beside({stacked(rows, picture_gap_px), key}, picture_gap_px), picture_gap_px);
}

}  // namespace tofmap
