// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/frame_pictures.hpp"

#include "quantile.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tofmap {
namespace {

constexpr int gap_px = 16;

/// Every pixel of an image by its colour, magnified to a picture of about the same size for all
/// cameras.
template <class Color>
Picture image_picture(Eigen::Index rows, Eigen::Index cols, const Color& color) {
  constexpr Eigen::Index wanted_width_px = 530;
  Picture small(static_cast<int>(cols), static_cast<int>(rows));
  for (int v = 0; v < small.height_px; ++v) {
    for (int u = 0; u < small.width_px; ++u) small.at(u, v) = color(v, u);
  }
  const Eigen::Index factor = wanted_width_px / std::max<Eigen::Index>(1, cols);
  return magnified(small, static_cast<int>(std::max<Eigen::Index>(1, factor)));
}

/// A round number that all but the farthest few of the ranges stay below; 1 if there are none.
double round_limit_m(const ImageF& range_m) {
  constexpr double share = 0.998;
  return std::max(1.0F, std::ceil(finite_quantile(range_m, share).value_or(1)));
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
  const Picture legend = stacked({color_bar(scale, wrapped.height_px - 3 * gap_px),
                                  color_key({{colors::invalid, "no range"}})},
                                 gap_px);
  return with_margin(beside({wrapped, unwrapped, legend}, gap_px), gap_px);
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
  return with_margin(beside({titled(panel, "wrap count"), color_key(entries)}, gap_px), gap_px);
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
  const Picture legend = stacked(
      {color_bar(scale, panel.height_px - 3 * gap_px), color_key({{colors::invalid, "no range"}})},
      gap_px);
  return with_margin(beside({panel, legend}, gap_px), gap_px);
}

Picture jump_picture(const std::vector<JumpStage>& stages) {
  std::vector<Picture> rows;
  for (const JumpStage& stage : stages) {
    rows.push_back(beside({titled(jump_panel(*stage.x), stage.title + ", in x"),
                           titled(jump_panel(*stage.y), stage.title + ", in y")},
                          gap_px));
  }
  const Picture key = color_key({{jump_color(1, 0, 0), "-1: one wrap more"},
                                 {jump_color(0, 1, 0), "0: no jump"},
                                 {jump_color(0, 0, 1), "+1: one wrap less"},
                                 {colors::invalid, "no node"}});
  return with_margin(beside({stacked(rows, gap_px), key}, gap_px), gap_px);
}

}  // namespace tofmap
