// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tofmap {

/// A colour in sRGB, 8 bits per channel.
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
inline constexpr Rgb corrected{214, 39, 40};  ///< a point that unwrapping moved (red)
inline constexpr Rgb path{230, 90, 0};        ///< the path of the camera
inline constexpr Rgb gone{214, 39, 40};       ///< a surface that is no longer there
inline constexpr Rgb appeared{44, 160, 44};   ///< a surface that was not there before
inline constexpr Rgb moved{31, 119, 180};     ///< a surface that was elsewhere before
}  // namespace colors

/// Sequences of colours for a scale. Lightness changes evenly along each, so that the order is
/// visible in grey and to colour-blind readers, too.
enum class ColorRamp {
  quantity,  ///< from dark blue through green to light yellow
  error,     ///< from light grey through orange to dark red, so that large errors stand out
};

/// Maps the values of a quantity between two limits to colours.
class ColorScale {
 public:
  /// `label` is the quantity with its unit, for the legend. Throws UsageError unless low < high.
  ColorScale(double low, double high, std::string label, ColorRamp ramp = ColorRamp::quantity);

  /// The colour of a value. Values outside the limits get the colour of the nearest limit, NaN gets
  /// `colors::invalid`.
  Rgb operator()(double value) const;

  double low() const { return low_; }
  double high() const { return high_; }
  const std::string& label() const { return label_; }

  /// About `count` round values between the limits, for a legend.
  std::vector<double> ticks(int count) const;

 private:
  double low_;
  double high_;
  std::string label_;
  ColorRamp ramp_;
};

/// The colour of a wrap count ≥ 0. The colours of successive wrap counts differ clearly, also for
/// colour-blind readers, and repeat after 8.
Rgb wrap_count_color(int count);

/// The colour of the probabilities of a jump node, as in figure 7 of the paper: a mixture of blue
/// for configuration −1, green for 0 and red for +1. `colors::invalid` if one of them is NaN.
Rgb jump_color(float minus, float none, float plus);

}  // namespace tofmap
