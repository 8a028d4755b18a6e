// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tofmap {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Rgb&, const Rgb&) = default;
};

namespace colors {
inline constexpr Rgb white{255, 255, 255};
inline constexpr Rgb black{0, 0, 0};
inline constexpr Rgb invalid{190, 190, 190};  ///< a pixel without a value
inline constexpr Rgb corrected{214, 39, 40};  ///< red: a point that unwrapping moved
inline constexpr Rgb path{230, 90, 0};        ///< where the camera went
}  // namespace colors

/// Colours in an order. Lightness changes evenly along it, so the order is seen in grey, too, and
/// by those who do not tell red from green.
enum class ColorRamp {
  quantity,  ///< from dark blue over green to light yellow
  error,     ///< from light grey over orange to dark red: what is wrong stands out
};

/// Colours of a quantity between two limits.
class ColorScale {
 public:
  /// `label` names quantity and unit, for the legend. Throws UsageError unless low < high.
  ColorScale(double low, double high, std::string label, ColorRamp ramp = ColorRamp::quantity);

  /// Values beyond the limits get the colour of the limit; NaN is `colors::invalid`.
  Rgb operator()(double value) const;

  double low() const { return low_; }
  double high() const { return high_; }
  const std::string& label() const { return label_; }

  /// Round values between the limits, about `count` of them, for a legend.
  std::vector<double> ticks(int count) const;

 private:
  double low_;
  double high_;
  std::string label_;
  ColorRamp ramp_;
};

/// The colour of a wrap count: neighbouring counts differ clearly, for all kinds of eyes; they
/// repeat after 8.
Rgb wrap_count_color(int count);

/// The colour of a jump node's probabilities, as in figure 7 of the paper: blue for
/// configuration −1, green for 0, red for +1, mixed by their shares. NaN is invalid.
Rgb jump_color(float minus, float none, float plus);

}  // namespace tofmap
