// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/compact_cloud.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include <zlib.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The first byte is the exponent of the range step, 2^(exponent − step_bias) metres. The planes
// follow, one byte for each pixel. All but the first row of a plane holds differences from the
// pixel above, which are small and compress well.
constexpr int step_bias = 12;
constexpr int largest_exponent = 12;
enum Plane { range_high, range_low, normal_high, normal_u, normal_v, sigma, tilt, confidence };
constexpr std::size_t planes = 8;

constexpr long largest_range_code = 65535;  // 0: no range
constexpr int octahedral_steps = 4094;      // 4095, the largest number of 12 bits: no normal
constexpr std::uint32_t no_normal = 4095;
constexpr int confidence_steps = 250;
constexpr std::uint8_t negative_confidence = 255;

double step_m(int exponent) { return std::ldexp(1.0, exponent - step_bias); }

/// The exponent of the smallest step at which all ranges have a code.
int exponent_for(const SurfaceCloud& cloud) {
  double farthest_m = 0;
  for (const SurfacePoint& point : cloud.points) {
    if (!point.has_position()) continue;
    farthest_m = std::max<double>(farthest_m, point.getVector3fMap().norm());
  }
  int exponent = 0;
  while (exponent < largest_exponent && farthest_m / step_m(exponent) >= largest_range_code) {
    ++exponent;
  }
  if (farthest_m / step_m(exponent) >= largest_range_code) {
    throw UsageError("a point of the cloud is farther away than " +
                     std::to_string(step_m(exponent) * largest_range_code / 1000) + " km");
  }
  return exponent;
}

// A positive number with a mantissa of four bits and an exponent of four bits; 0: not a number.
constexpr int mantissa_steps = 16;
constexpr int exponents = 16;
constexpr int number_bias = 14;

std::uint8_t encode_number(float number) {
  if (!std::isfinite(number)) return 0;
  int exponent = 0;
  const double mantissa = 2 * std::frexp(std::max(number, 0.0F), &exponent);  // 1 … 2, or 0
  const long code =
      (exponent - 1 + number_bias) * mantissa_steps + std::lround((mantissa - 1) * mantissa_steps);
  return static_cast<std::uint8_t>(std::clamp<long>(code, 1, mantissa_steps * exponents - 1));
}

float decode_number(std::uint8_t code) {
  if (code == 0) return nan;
  const double mantissa = 1 + static_cast<double>(code % mantissa_steps) / mantissa_steps;
  return static_cast<float>(std::ldexp(mantissa, code / mantissa_steps - number_bias));
}

std::uint8_t encode_confidence(float confidence) {
  if (confidence < 0) return negative_confidence;
  return static_cast<std::uint8_t>(std::lround(std::min(confidence, 1.0F) * confidence_steps));
}

float decode_confidence(std::uint8_t code) {
  if (code == negative_confidence) return -1;
  return static_cast<float>(code) / confidence_steps;
}

struct Octahedral {
  std::uint32_t u = no_normal;
  std::uint32_t v = no_normal;
};

/// The reflection of a coordinate of the lower half of the octahedron, and back.
float folded(float own, float other) { return std::copysign(1 - std::abs(other), own); }

Octahedral encode_normal(const Eigen::Vector3f& normal) {
  const Eigen::Vector3f on_octahedron = normal / normal.lpNorm<1>();
  float u = on_octahedron.x();
  float v = on_octahedron.y();
  if (on_octahedron.z() < 0) {
    u = folded(on_octahedron.x(), on_octahedron.y());
    v = folded(on_octahedron.y(), on_octahedron.x());
  }
  const auto code = [](float coordinate) {
    return static_cast<std::uint32_t>(std::lround((coordinate + 1) / 2 * octahedral_steps));
  };
  return {code(u), code(v)};
}

Eigen::Vector3f decode_normal(const Octahedral& code) {
  const auto coordinate = [](std::uint32_t number) {
    return static_cast<float>(number) / octahedral_steps * 2 - 1;
  };
  const float u = coordinate(code.u);
  const float v = coordinate(code.v);
  Eigen::Vector3f normal(u, v, 1 - std::abs(u) - std::abs(v));
  if (normal.z() < 0) {
    normal.x() = folded(u, v);
    normal.y() = folded(v, u);
  }
  return normal.normalized();
}

/// Replaces the rows of a plane, but the first, by their differences from the row above.
void take_differences(std::span<std::uint8_t> plane, std::size_t width) {
  for (std::size_t i = plane.size() - 1; i >= width; --i) {
    plane[i] = static_cast<std::uint8_t>(plane[i] - plane[i - width]);
  }
}

void add_differences(std::span<std::uint8_t> plane, std::size_t width) {
  for (std::size_t i = width; i < plane.size(); ++i) {
    plane[i] = static_cast<std::uint8_t>(plane[i] + plane[i - width]);
  }
}

Bytes compressed(const Bytes& raw) {
  uLongf size = compressBound(raw.size());
  Bytes out(size);
  if (compress2(out.data(), &size, raw.data(), raw.size(), Z_BEST_SPEED) != Z_OK) {
    throw InputError("out of memory");
  }
  out.resize(size);
  out.shrink_to_fit();
  return out;
}

Bytes uncompressed(const Bytes& bytes, std::size_t expected) {
  Bytes raw(expected);
  uLongf size = expected;
  if (uncompress(raw.data(), &size, bytes.data(), bytes.size()) != Z_OK || size != expected) {
    throw InputError("a compact cloud is damaged");
  }
  return raw;
}

void encode(const SurfacePoint& point, double step, const std::array<std::uint8_t*, planes>& at,
            std::size_t i) {
  if (!point.has_position()) return;
  const double range_m = point.getVector3fMap().cast<double>().norm();
  const long range = std::max(1L, std::lround(range_m / step));
  const Octahedral normal =
      point.has_normal() ? encode_normal(point.getNormalVector3fMap()) : Octahedral{};
  constexpr int byte = 8;
  at[range_high][i] = static_cast<std::uint8_t>(range >> byte);
  at[range_low][i] = static_cast<std::uint8_t>(range);
  at[normal_high][i] = static_cast<std::uint8_t>((normal.u >> byte) << 4 | normal.v >> byte);
  at[normal_u][i] = static_cast<std::uint8_t>(normal.u);
  at[normal_v][i] = static_cast<std::uint8_t>(normal.v);
  at[sigma][i] = encode_number(point.sigma_m);
  at[tilt][i] = encode_number(point.normal_sigma_rad);
  at[confidence][i] = encode_confidence(point.confidence);
}

SurfacePoint decode(double step, const std::array<std::uint8_t*, planes>& at, std::size_t i,
                    const Eigen::Vector3f& ray) {
  constexpr int byte = 8;
  constexpr std::uint32_t half_byte = 15;
  SurfacePoint point;
  point.data[3] = 1;
  point.data_n[3] = 0;
  point.getNormalVector3fMap().setConstant(nan);
  const int range = at[range_high][i] << byte | at[range_low][i];
  if (range == 0) {
    point.getVector3fMap().setConstant(nan);
    point.sigma_m = point.normal_sigma_rad = nan;
    point.confidence = 0;
    return point;
  }
  point.getVector3fMap() = static_cast<float>(range * step) * ray;
  const std::uint32_t high = at[normal_high][i];
  const Octahedral normal{(high >> 4) << byte | at[normal_u][i],
                          (high & half_byte) << byte | at[normal_v][i]};
  if (normal.u != no_normal) point.getNormalVector3fMap() = decode_normal(normal);
  point.sigma_m = decode_number(at[sigma][i]);
  point.normal_sigma_rad = decode_number(at[tilt][i]);
  point.confidence = decode_confidence(at[confidence][i]);
  return point;
}

std::array<std::uint8_t*, planes> planes_of(Bytes& raw, std::size_t pixels) {
  std::array<std::uint8_t*, planes> at{};
  for (std::size_t plane = 0; plane < planes; ++plane) at[plane] = raw.data() + 1 + plane * pixels;
  return at;
}

SurfaceCloud expanded(const CompactCloud& compact, const PixelRays& rays) {
  if (compact.width_px != rays.x.cols() || compact.height_px != rays.x.rows()) {
    throw InputError("a compact cloud has another size than the images of its camera");
  }
  const auto pixels = static_cast<std::size_t>(rays.x.size());
  Bytes raw = uncompressed(compact.bytes, 1 + planes * pixels);
  if (raw.front() > largest_exponent) throw InputError("a compact cloud is damaged");
  const auto at = planes_of(raw, pixels);
  for (std::uint8_t* plane : at) add_differences({plane, pixels}, compact.width_px);
  SurfaceCloud cloud;
  cloud.width = static_cast<std::uint32_t>(compact.width_px);
  cloud.height = static_cast<std::uint32_t>(compact.height_px);
  cloud.is_dense = false;
  cloud.points.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto p = static_cast<Eigen::Index>(i);
    cloud.points[i] =
        decode(step_m(raw.front()), at, i, {rays.x.data()[p], rays.y.data()[p], rays.z.data()[p]});
  }
  return cloud;
}

}  // namespace

CompactCloud compact(const SurfaceCloud& cloud) {
  const std::size_t pixels = cloud.points.size();
  if (pixels == 0 || pixels != std::size_t{cloud.width} * cloud.height) {
    throw UsageError("a cloud without points, or one that is not organised, cannot be compact");
  }
  const int exponent = exponent_for(cloud);
  Bytes raw(1 + planes * pixels);
  raw.front() = static_cast<std::uint8_t>(exponent);
  const auto at = planes_of(raw, pixels);
  for (std::size_t i = 0; i < pixels; ++i) encode(cloud.points[i], step_m(exponent), at, i);
  for (std::uint8_t* plane : at) take_differences({plane, pixels}, cloud.width);
  return {static_cast<int>(cloud.width), static_cast<int>(cloud.height), compressed(raw)};
}

SurfaceCloud expand(const CompactCloud& compact, const PixelRays& rays) {
  if (compact.origin.empty()) return expanded(compact, rays);
  return naming(compact.origin, [&] { return expanded(compact, rays); });
}

}  // namespace tofmap
