// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

// Colours between these are interpolated linearly.
constexpr std::array<Rgb, 9> quantity_colors{{{24, 16, 80},
                                              {30, 48, 128},
                                              {22, 82, 152},
                                              {16, 114, 158},
                                              {24, 144, 150},
                                              {64, 172, 128},
                                              {128, 196, 100},
                                              {196, 214, 84},
                                              {252, 232, 112}}};

constexpr std::array<Rgb, 6> error_colors{
    {{218, 224, 230}, {238, 196, 140}, {232, 150, 70}, {204, 98, 40}, {150, 44, 36}, {84, 8, 32}}};

std::span<const Rgb> colors_of(ColorRamp ramp) {
  if (ramp == ColorRamp::error) return error_colors;
  return quantity_colors;
}

std::uint8_t mixed(std::uint8_t a, std::uint8_t b, double share) {
  return static_cast<std::uint8_t>(std::lround(a + (b - a) * share));
}

std::uint8_t to_byte(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

}  // namespace

ColorScale::ColorScale(double low, double high, std::string label, ColorRamp ramp)
    : low_(low), high_(high), label_(std::move(label)), ramp_(ramp) {
  if (!(low < high)) {
    throw UsageError("color scale: low is " + std::to_string(low) + " and high " +
                     std::to_string(high) + "; low must be less than high");
  }
}

Rgb ColorScale::operator()(double value) const {
  if (std::isnan(value)) return colors::invalid;
  const std::span<const Rgb> colors = colors_of(ramp_);
  const auto steps = static_cast<double>(colors.size() - 1);
  const double place = std::clamp((value - low_) / (high_ - low_), 0.0, 1.0) * steps;
  const auto step = static_cast<std::size_t>(std::min(std::floor(place), steps - 1));
  const Rgb& a = colors[step];
  const Rgb& b = colors[step + 1];
  const double share = place - static_cast<double>(step);
  return {mixed(a.red, b.red, share), mixed(a.green, b.green, share), mixed(a.blue, b.blue, share)};
}

std::vector<double> ColorScale::ticks(int count) const {
  const double rough = (high_ - low_) / std::max(1, count);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double round : {5.0, 2.0, 1.0}) {
    if (round * power >= rough) step = round * power;
  }
  std::vector<double> out;
  for (double i = std::ceil(low_ / step - 1e-9); i * step <= high_ + 1e-9 * step; ++i) {
    out.push_back(i * step + 0.0);  // no −0
  }
  return out;
}

Rgb wrap_count_color(int count) {
  // The palette of Okabe and Ito for colour-blind readers. Wrap count 0 is light.
  constexpr std::array<Rgb, 8> palette{{{240, 228, 66},
                                        {0, 114, 178},
                                        {230, 159, 0},
                                        {0, 158, 115},
                                        {204, 121, 167},
                                        {86, 180, 233},
                                        {213, 94, 0},
                                        {0, 0, 0}}};
  const auto place = static_cast<std::size_t>(count);
  const Rgb color = palette[place % palette.size()];
  // Later rounds through the palette are mixed with white, then with a middle grey, and so on.
  const std::size_t round = place / palette.size();
  if (round == 0) return color;
  const int other = round % 2 == 1 ? 255 : 96;
  const auto mixed = [other](std::uint8_t own) {
    return static_cast<std::uint8_t>((9 * own + 11 * other) / 20);
  };
  return {mixed(color.red), mixed(color.green), mixed(color.blue)};
}

Rgb jump_color(float minus, float none, float plus) {
  if (std::isnan(minus + none + plus)) return colors::invalid;
  return {to_byte(plus), to_byte(none), to_byte(minus)};
}

}  // namespace tofmap
