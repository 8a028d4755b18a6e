// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures ranges under extreme phase noise, and prints a Markdown table:
//
//     bench_extreme_noise [--seed N] [--divide N] [--frequencies MHZ[,MHZ]...] [--pictures DIR]
// The frames resemble a recording without amplitudes at 37.65 and 45.18 MHz, or at the given
// frequencies: exact phases of simulated rooms with ranges of 2 to 9 m, and the same noise in all
// pixels. The filters are compared with blurring: the phasors of all frequencies are smoothed by a
// Gaussian of 8 pixels, and each pixel gets the range of largest likelihood.

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <tofmap/core/median.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/unwrap.hpp>
#include <tofmap/visualization/color.hpp>
#include <tofmap/visualization/picture.hpp>

namespace tofmap::bench {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

enum class NoiseKind { wrapped_normal, complex_normal };

struct Noise {
  NoiseKind kind;
  double sigma_rad;
};

/// The standard deviation of the real and imaginary part of noise on a unit phasor for which the
/// phase has the same mean resultant length as a wrapped normal distribution of `sigma_rad`.
double complex_sigma(double sigma_rad) {
  constexpr int draws = 200000;
  const double wanted = std::exp(-sigma_rad * sigma_rad / 2);
  const auto length = [&](double sigma) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0, sigma);
    double cosines = 0;
    for (int i = 0; i < draws; ++i) {
      const double re = 1 + normal(random);
      const double im = normal(random);
      cosines += re / std::hypot(re, im);
    }
    return cosines / draws;
  };
  double low = 0;
  double high = 20;
  for (int i = 0; i < 20; ++i) {
    const double middle = (low + high) / 2;
    (length(middle) > wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Noisy phases of ranges, cycles.
ImageF noisy_phase(const ImageF& range_m, double wavelength_m, const Noise& noise,
                   std::mt19937_64& random) {
  const bool is_complex = noise.kind == NoiseKind::complex_normal;
  std::normal_distribution<double> normal(
      0, is_complex ? complex_sigma(noise.sigma_rad) : noise.sigma_rad);
  ImageF phase(range_m.rows(), range_m.cols());
  for (Eigen::Index i = 0; i < range_m.size(); ++i) {
    double angle = two_pi * range_m.data()[i] / wavelength_m;
    if (is_complex) {
      const double re = std::cos(angle) + normal(random);
      const double im = std::sin(angle) + normal(random);
      angle = std::atan2(im, re);
    } else {
      angle += normal(random);
    }
    const double cycles = angle / two_pi;
    phase.data()[i] = std::min(static_cast<float>(cycles - std::floor(cycles)), 0.9999999F);
  }
  return phase;
}

struct Sample {
  std::string scene;
  SensorModel sensor;
  PixelRays rays;
  ImageF truth_m;
};

bool is_of_the_kind(const ImageF& truth_m) {
  int inside = 0;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const float range_m = truth_m.data()[i];
    inside += range_m > 2 && range_m < 9 ? 1 : 0;
  }
  return inside > 0.8 * static_cast<double>(truth_m.size());
}

/// Frames of a scene in which more than 80 % of the ranges are from 2 to 9 m.
std::vector<Sample> samples_of(const std::string& scene, int seed, int frames, int width,
                               int height, const std::vector<double>& frequencies_hz) {
  SimulatorOptions options;
  options.width_px = width;
  options.height_px = height;
  options.frequencies_hz = frequencies_hz;
  options.subpixels = 1;
  options.seed = seed;
  const Simulator simulator(make_scene(scene, seed), options);
  std::vector<Sample> samples;
  const int total = *simulator.frame_count();
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  for (int tries = 0; tries < 8 * frames && static_cast<int>(samples.size()) < frames; ++tries) {
    const int index = static_cast<int>(random() % static_cast<std::uint64_t>(total));
    const SimulatedFrame frame = simulator.simulate(index);
    if (!is_of_the_kind(frame.range_truth_m)) continue;
    SensorModel sensor = simulator.sensor();
    sensor.max_range_m = 0;
    samples.push_back({scene, sensor, pixel_rays(sensor.camera), frame.range_truth_m});
  }
  return samples;
}

/// The most likely ranges for phasors smoothed by a Gaussian.
ImageF blurred_ranges(const Frame& frame, const Modulation& modulation, double sigma_px) {
  const auto rows = frame.phases[0].rows();
  const auto cols = frame.phases[0].cols();
  const int reach = static_cast<int>(std::ceil(3 * sigma_px));
  using Plane = Image<std::complex<double>>;
  const auto blurred = [&](const ImageF& phase) {
    Plane plane(rows, cols);
    for (Eigen::Index i = 0; i < phase.size(); ++i) {
      const float p = phase.data()[i];
      plane.data()[i] = std::isfinite(p) ? std::polar(1.0, two_pi * p) : 0.0;
    }
    const auto along = [&](const Plane& in, int step_v, int step_u) {
      Plane out = Plane::Zero(rows, cols);
      for (int v = 0; v < rows; ++v) {
        for (int u = 0; u < cols; ++u) {
          for (int k = -reach; k <= reach; ++k) {
            const int y = v + k * step_v;
            const int x = u + k * step_u;
            if (y < 0 || x < 0 || y >= rows || x >= cols) continue;
            out(v, u) += std::exp(-0.5 * k * k / (sigma_px * sigma_px)) * in(y, x);
          }
        }
      }
      return out;
    };
    return along(along(plane, 1, 0), 0, 1);
  };
  std::vector<Plane> planes;
  for (const ImageF& phase : frame.phases) planes.push_back(blurred(phase));
  constexpr double step_m = 0.04;  // much smaller than the error limit of 0.3 m
  const auto steps = static_cast<int>(std::ceil(combined_range_m(modulation) / step_m));
  std::vector<std::vector<std::complex<double>>> turns(planes.size());
  for (std::size_t f = 0; f < planes.size(); ++f) {
    for (int step = 0; step < steps; ++step) {
      turns[f].push_back(std::polar(1.0, -two_pi * step * step_m / modulation.wavelength_m(f)));
    }
  }
  ImageF range_m(rows, cols);
  for (Eigen::Index i = 0; i < range_m.size(); ++i) {
    double best = -1e30;
    for (std::size_t k = 0; k < static_cast<std::size_t>(steps); ++k) {
      double fit = 0;
      for (std::size_t f = 0; f < planes.size(); ++f) {
        fit += (planes[f].data()[i] * turns[f][k]).real();
      }
      if (fit <= best) continue;
      best = fit;
      range_m.data()[i] = static_cast<float>(step_m * static_cast<double>(k));
    }
  }
  return range_m;
}

/// Statistics of the ranges of one method.
struct Tally {
  double pixels = 0;
  double valid = 0;
  double near = 0;
  double wrong_wraps = 0;
  double confidence = 0;
  std::vector<float> deviations;  ///< errors divided by sigma_m

  void add(const RangeImage& image, const Sample& sample) {
    constexpr float near_m = 0.3F;
    const auto half_m = static_cast<float>(sample.sensor.modulation.wavelength_m(0) / 2);
    for (Eigen::Index i = 0; i < image.range_m.size(); ++i) {
      const float truth_m = sample.truth_m.data()[i];
      if (!std::isfinite(truth_m)) continue;
      pixels += 1;
      const float error_m = std::abs(image.range_m.data()[i] - truth_m);
      if (!std::isfinite(error_m)) continue;
      valid += 1;
      near += error_m <= near_m ? 1 : 0;
      wrong_wraps += error_m > half_m ? 1 : 0;
      confidence += image.confidence.data()[i];
      deviations.push_back(error_m / image.sigma_m.data()[i]);
    }
  }

  void add(const Tally& other) {
    pixels += other.pixels;
    valid += other.valid;
    near += other.near;
    wrong_wraps += other.wrong_wraps;
    confidence += other.confidence;
    std::ranges::copy(other.deviations, std::back_inserter(deviations));
  }

  double near_percent() const { return 100 * near / valid; }
  double wrong_percent() const { return 100 * wrong_wraps / valid; }
  double coverage_percent() const { return 100 * valid / pixels; }
  double unsure_percent() const { return 100 * (1 - confidence / valid); }

  /// The median error in units of sigma_m, scaled so that it is 1 for a correct sigma_m and normal
  /// noise, whose median absolute error is 0.6745 σ.
  double median_deviation() const {
    std::vector<float> sizes = deviations;
    return static_cast<double>(median(sizes)) / 0.6745;
  }
};

/// The statistics of all methods that are compared.
struct Tallies {
  Tally pixel;
  Tally joint;
  Tally without;  ///< the chain without phasor_mean
  Tally chain;
  Tally blurred;
  int frames = 0;

  void add(const Tallies& other) {
    pixel.add(other.pixel);
    joint.add(other.joint);
    without.add(other.without);
    chain.add(other.chain);
    blurred.add(other.blurred);
    frames += other.frames;
  }
};

RangeImage ranges_alone(const ImageF& range_m) {
  RangeImage image(range_m.rows(), range_m.cols());
  image.range_m = range_m;
  image.sigma_m.setOnes();
  image.reason.setZero();
  return image;
}

Frame noisy_frame(const Sample& sample, const Noise& noise, std::mt19937_64& random) {
  const Modulation& modulation = sample.sensor.modulation;
  Frame frame = blank_frame(modulation.count());
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    frame.phases[f] = noisy_phase(sample.truth_m, modulation.wavelength_m(f), noise, random);
  }
  return frame;
}

/// A picture of the true ranges and the ranges of each method, with the errors below them.
Picture sheet_of(const Sample& sample, const std::vector<const ImageF*>& ranges) {
  const ColorScale range_scale(0, 12, "range, m");
  const ColorScale error_scale(0, 0.6, "error, m", ColorRamp::error);
  std::vector<Picture> columns;
  for (const ImageF* range_m : ranges) {
    const int width = static_cast<int>(range_m->cols());
    const int height = static_cast<int>(range_m->rows());
    Picture column(width, 2 * height);
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        column.at(u, v) = range_scale((*range_m)(v, u));
        column.at(u, v + height) = error_scale(std::abs((*range_m)(v, u) - sample.truth_m(v, u)));
      }
    }
    columns.push_back(column);
  }
  return beside(columns, 2);
}

/// Adds one frame to the statistics of all methods. Writes a picture of it if `picture` is not
/// empty.
void compare(const Sample& sample, const Noise& noise, unsigned seed,
             const std::filesystem::path& picture, Tallies& tallies) {
  std::mt19937_64 random(seed);
  const Modulation& modulation = sample.sensor.modulation;
  const Frame frame = noisy_frame(sample, noise, random);
  UnwrapOptions pixelwise;
  pixelwise.method = UnwrapMethod::pixel;
  const RangeImage joint = unwrap(frame, sample.sensor, {}).image;
  FilterOptions options;
  options.chain = smoothing_chain();
  const RangeImage filtered = apply_filters(joint, frame, modulation, sample.rays, options).image;
  if (std::erase(options.chain, Filter::phasor_mean) == 0) {
    throw std::logic_error("phasor_mean is not in the chain");
  }
  const RangeImage without = apply_filters(joint, frame, modulation, sample.rays, options).image;
  const ImageF blurred_m = blurred_ranges(frame, modulation, 8);
  tallies.pixel.add(unwrap(frame, sample.sensor, pixelwise).image, sample);
  tallies.joint.add(joint, sample);
  tallies.without.add(without, sample);
  tallies.chain.add(filtered, sample);
  tallies.blurred.add(ranges_alone(blurred_m), sample);
  tallies.frames += 1;
  if (!picture.empty()) {
    write_picture(picture, sheet_of(sample, {&sample.truth_m, &joint.range_m, &without.range_m,
                                             &blurred_m, &filtered.range_m}));
  }
}

void print_heading() {
  std::printf(
      "| noise | frames | wrong wraps: `pixel` | `joint` | within 0.3 m: `joint` | without "
      "`phasor_mean` | Gaussian, 8 px | chain | wrong wraps | by confidence | kept | error / "
      "sigma_m |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print(const std::string& noise, const std::string& frames, const Tallies& t) {
  std::printf(
      "| %s | %d x %s | %.1f | %.1f | %.1f | %.1f | %.1f | **%.1f** | %.2f | %.2f | %.1f | %.2f "
      "|\n",
      noise.c_str(), t.frames, frames.c_str(), t.pixel.wrong_percent(), t.joint.wrong_percent(),
      t.joint.near_percent(), t.without.near_percent(), t.blurred.near_percent(),
      t.chain.near_percent(), t.chain.wrong_percent(), t.chain.unsure_percent(),
      t.chain.coverage_percent(), t.chain.median_deviation());
  std::fflush(stdout);
}

std::string name_of(const Noise& noise) {
  char text[40];
  std::snprintf(text, sizeof text, "%s %.2f",
                noise.kind == NoiseKind::complex_normal ? "complex" : "wrapped", noise.sigma_rad);
  return text;
}

struct Arguments {
  int seed = 901;
  int divisor = 1;
  std::vector<double> frequencies_mhz = {37.65, 45.18};
  std::filesystem::path pictures;
};

/// Frames of one scene and image size.
struct Group {
  std::string name;
  std::vector<Sample> samples;
};

std::vector<Group> make_groups(const Arguments& arguments) {
  struct Size {
    int width;
    int height;
  };
  std::vector<double> frequencies_hz;
  for (const double mhz : arguments.frequencies_mhz) frequencies_hz.push_back(1e6 * mhz);
  std::vector<Group> groups;
  for (const Size size : {Size{176, 144}, Size{320, 240}}) {
    for (const char* scene : {"random", "flat", "room", "hall"}) {
      Group group{std::string(scene) + ", " + std::to_string(size.width) + " x " +
                      std::to_string(size.height),
                  {}};
      // Many random rooms are too large for ranges of 2 to 9 m.
      const int seeds = std::max(1, (std::string(scene) == "random" ? 12 : 4) / arguments.divisor);
      for (int seed = arguments.seed; seed < arguments.seed + seeds; ++seed) {
        std::ranges::move(samples_of(scene, seed, 1, size.width, size.height, frequencies_hz),
                          std::back_inserter(group.samples));
      }
      if (!group.samples.empty()) groups.push_back(std::move(group));
    }
  }
  return groups;
}

void run(const Arguments& arguments) {
  if (!arguments.pictures.empty()) std::filesystem::create_directories(arguments.pictures);
  const std::vector<Group> groups = make_groups(arguments);
  print_heading();
  for (const double sigma_rad : {1.35, 1.6}) {
    for (const NoiseKind kind : {NoiseKind::wrapped_normal, NoiseKind::complex_normal}) {
      const Noise noise{kind, sigma_rad};
      Tallies all;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        Tallies tallies;
        for (std::size_t i = 0; i < groups[g].samples.size(); ++i) {
          const unsigned seed =
              static_cast<unsigned>(arguments.seed) + 1000U * static_cast<unsigned>(100 * g + i);
          std::filesystem::path picture;
          if (!arguments.pictures.empty() && i == 0) {
            picture = arguments.pictures / (name_of(noise) + ", " + groups[g].name + ".png");
          }
          compare(groups[g].samples[i], noise, seed, picture, tallies);
        }
        print(name_of(noise), groups[g].name, tallies);
        all.add(tallies);
      }
      print(name_of(noise), "all", all);
    }
  }
}

}  // namespace
}  // namespace tofmap::bench

int main(int argc, char** argv) {
  tofmap::bench::Arguments arguments;
  CLI::App app{"measures ranges under extreme phase noise"};
  app.add_option("--seed", arguments.seed, "first seed of the scenes");
  app.add_option("--divide", arguments.divisor, "divides the number of frames")
      ->check(CLI::PositiveNumber);
  app.add_option("--frequencies", arguments.frequencies_mhz, "modulation frequencies, MHz")
      ->delimiter(',');
  app.add_option("--pictures", arguments.pictures, "folder for pictures of some frames");
  CLI11_PARSE(app, argc, argv);
  try {
    tofmap::bench::run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_extreme_noise: %s\n", error.what());
    return 2;
  }
  return 0;
}
