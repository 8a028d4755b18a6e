// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/pixel_label.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// Rays are cast in single precision: some 1e-6 of 10 m.
constexpr float tolerance_m = 5e-5F;

struct FrameErrors {
  ImageF a_m;
  ImageF b_m;
};

FrameErrors range_errors_m(const Simulator& simulator, int frame = 0) {
  const SimulatedFrame simulated = simulator.simulate(frame);
  const Modulation& modulation = simulator.sensor().modulation;
  const ImageF& truth_m = simulated.range_truth_m;
  return {test::range_error_m(simulated.frame.phases[0], truth_m, modulation.wavelength_m(0)),
          test::range_error_m(simulated.frame.phases[1], truth_m, modulation.wavelength_m(1))};
}

bool same_pixels(const SimulatedFrame& one, const SimulatedFrame& other) {
  return (one.frame.phases[0] == other.frame.phases[0]).all() &&
         (one.frame.phases[1] == other.frame.phases[1]).all() &&
         (one.frame.amplitudes[0] == other.frame.amplitudes[0]).all() &&
         (one.frame.amplitudes[1] == other.frame.amplitudes[1]).all() &&
         (one.label == other.label).all();
}

TEST(SystematicErrors, OfSizeZeroLeaveEveryBitAsItIs) {
  SimulatorOptions options = test::ideal_camera();
  options.range_noise_m = 0.02;
  const SimulatedFrame plain = Simulator(test::facing_wall_scene(3, 0.5), options).simulate(0);
  options.errors_seed = 77;
  options.ambient_left = 0.1;
  options.ambient_bottom = 0.9;
  EXPECT_TRUE(same_pixels(plain, Simulator(test::facing_wall_scene(3, 0.5), options).simulate(0)));
}

TEST(RangeOffset, IsThatOfEachFrequency) {
  SimulatorOptions options = test::ideal_camera();
  options.offset_a_m = -0.03;
  options.offset_b_m = 0.05;
  const FrameErrors errors = range_errors_m(Simulator(test::facing_wall_scene(3, 0.5), options));
  EXPECT_LT((errors.a_m + 0.03F).abs().maxCoeff(), tolerance_m);
  EXPECT_LT((errors.b_m - 0.05F).abs().maxCoeff(), tolerance_m);
}

/// What harmonics of order 2 and 4 leave of errors, root mean square; and their amplitudes.
struct HarmonicFit {
  double left_m = 0;
  double second_m = 0;
  double fourth_m = 0;
  double second_phase_rad = 0;
};

HarmonicFit fit_harmonics(const ImageF& error_m, const ImageF& range_m, double wavelength_m) {
  Eigen::MatrixX4d basis(error_m.size(), 4);
  Eigen::VectorXd wanted(error_m.size());
  for (Eigen::Index i = 0; i < error_m.size(); ++i) {
    const double angle = 2 * std::numbers::pi * range_m.data()[i] / wavelength_m;
    basis.row(i) << std::cos(2 * angle), std::sin(2 * angle), std::cos(4 * angle),
        std::sin(4 * angle);
    wanted(i) = error_m.data()[i];
  }
  const Eigen::Vector4d found = basis.colPivHouseholderQr().solve(wanted);
  return {(basis * found - wanted).norm() / std::sqrt(static_cast<double>(error_m.size())),
          found.head<2>().norm(), found.tail<2>().norm(), std::atan2(found(0), found(1))};
}

/// Over the image ranges go from 3 to 3.9 m: at these frequencies, a cycle and more.
SimulatorOptions short_waves() {
  SimulatorOptions options = test::ideal_camera();
  options.frequency_a_hz = 190e6;
  options.frequency_b_hz = 220e6;
  return options;
}

TEST(PeriodicError, HasTwoHarmonicsAndThePeakWantedForEachFrequency) {
  SimulatorOptions options = short_waves();
  options.periodic_a_m = 0.03;
  options.periodic_b_m = 0.01;
  for (int seed = 1; seed <= 8; ++seed) {
    options.errors_seed = seed;
    const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
    const ImageF range_m = simulator.simulate(0).range_truth_m;
    const FrameErrors errors = range_errors_m(simulator);
    const Modulation& modulation = simulator.sensor().modulation;
    const HarmonicFit a = fit_harmonics(errors.a_m, range_m, modulation.wavelength_m(0));
    const HarmonicFit b = fit_harmonics(errors.b_m, range_m, modulation.wavelength_m(1));
    for (const auto& [fit, error_m, peak_m] :
         {std::tuple(a, errors.a_m, 0.03), std::tuple(b, errors.b_m, 0.01)}) {
      EXPECT_LT(fit.left_m, tolerance_m) << seed;
      EXPECT_GT(std::min(fit.second_m, fit.fourth_m), 0.15 * peak_m) << seed;
      // A pixel is 5 cm of a cycle of 70 to 80 cm at most: its phase misses the peak by 0.1 rad.
      EXPECT_NEAR(error_m.abs().maxCoeff(), peak_m, 0.02 * peak_m) << seed;
    }
    EXPECT_GT(std::abs(a.second_phase_rad - b.second_phase_rad), 1e-3) << seed;
  }
}

TEST(PeriodicError, IsThatOfTheCameraAndNotOfTheNoise) {
  SimulatorOptions options = short_waves();
  options.periodic_a_m = 0.03;
  const auto errors_m = [&] {
    return range_errors_m(Simulator(test::facing_wall_scene(3, 0.5), options)).a_m;
  };
  const ImageF first_m = errors_m();
  options.seed = 2;
  EXPECT_LT((errors_m() - first_m).abs().maxCoeff(), tolerance_m);
  options.errors_seed = 2;
  EXPECT_GT((errors_m() - first_m).abs().maxCoeff(), 0.01F);
}

TEST(AmplitudeError, GoesWithTheLogarithmOfTheAmplitudeOverThreeDecades) {
  SimulatorOptions options = test::ideal_camera();
  options.amplitude_error_a_m = 0.03;
  options.amplitude_error_b_m = -0.02;
  // Amplitudes of 65535 (the end of the scale), 5400, 600 and 6.
  for (const auto& [range_m, reflectance] :
       {std::pair(0.25, 0.9), std::pair(1.0, 0.9), std::pair(2.0, 0.4), std::pair(10.0, 0.1)}) {
    const Simulator simulator(test::facing_wall_scene(range_m, reflectance), options);
    const FrameErrors errors = range_errors_m(simulator);
    const ImageF amplitude = simulator.simulate(0).frame.amplitudes[0];
    for (Eigen::Index i = 0; i < amplitude.size(); ++i) {
      const double darkness =
          std::clamp(std::log10(60000 / double{amplitude.data()[i]}) / 3, 0.0, 1.0);
      ASSERT_NEAR(errors.a_m.data()[i], 0.03 * darkness, tolerance_m) << range_m;
      ASSERT_NEAR(errors.b_m.data()[i], -0.02 * darkness, tolerance_m) << range_m;
    }
  }
}

TEST(FixedPattern, IsOfThePixelAndTheFrequencyAndTheSameInEveryFrame) {
  SimulatorOptions options = test::ideal_camera();
  options.fixed_pattern_m = 0.01;
  const Simulator simulator(test::facing_wall_scene(3, 0.5, 0.05), options);
  const FrameErrors errors = range_errors_m(simulator);
  const FrameErrors later = range_errors_m(simulator, 1);
  EXPECT_LT((errors.a_m - later.a_m).abs().maxCoeff(), tolerance_m);
  EXPECT_LT((errors.b_m - later.b_m).abs().maxCoeff(), tolerance_m);
  // 960 pixels: means scatter by 0.032 of the standard deviation, squares by 0.046; four times
  // that.
  const ImageF a = errors.a_m / 0.01F;
  const ImageF b = errors.b_m / 0.01F;
  EXPECT_NEAR(a.mean(), 0, 0.13);
  EXPECT_NEAR(b.mean(), 0, 0.13);
  EXPECT_NEAR(a.square().mean(), 1, 0.19);
  EXPECT_NEAR(b.square().mean(), 1, 0.19);
  EXPECT_NEAR((a * b).mean(), 0, 0.13);
}

TEST(FixedPattern, IsDrawnByTheErrorsSeedAlone) {
  SimulatorOptions options = test::ideal_camera();
  options.fixed_pattern_m = 0.01;
  const auto errors_m = [&] {
    return range_errors_m(Simulator(test::facing_wall_scene(3, 0.5), options)).a_m;
  };
  const ImageF first_m = errors_m();
  options.seed = 2;
  EXPECT_LT((errors_m() - first_m).abs().maxCoeff(), tolerance_m);
  options.errors_seed = 2;
  EXPECT_GT((errors_m() - first_m).square().mean(), 1e-4F) << "twice the variance of one";
}

TEST(SystematicErrors, AddUp) {
  SimulatorOptions options = test::ideal_camera();
  const Scene scene = test::facing_wall_scene(3, 0.5);
  ImageF sum_m = ImageF::Zero(options.height_px, options.width_px);
  const auto add_alone = [&](double SimulatorOptions::*size, double value) {
    SimulatorOptions alone = test::ideal_camera();
    alone.*size = value;
    options.*size = value;
    sum_m += range_errors_m(Simulator(scene, alone)).b_m;
  };
  add_alone(&SimulatorOptions::offset_b_m, -0.07);
  add_alone(&SimulatorOptions::periodic_b_m, 0.03);
  add_alone(&SimulatorOptions::amplitude_error_b_m, 0.03);
  add_alone(&SimulatorOptions::fixed_pattern_m, 0.01);
  EXPECT_LT((range_errors_m(Simulator(scene, options)).b_m - sum_m).abs().maxCoeff(),
            4 * tolerance_m);
}

TEST(AmbientLight, RaisesTheNoiseInItsPartOfTheImageAlone) {
  SimulatorOptions options = test::ideal_camera();
  options.width_px = 160;
  options.height_px = 120;
  options.range_noise_m = 0.02;
  const Scene scene = test::facing_wall_scene(3, 0.5);
  const SimulatedFrame dark = Simulator(scene, options).simulate(0);
  options.ambient_noise = 5;
  options.ambient_left = 0.25;
  options.ambient_right = 0.75;
  options.ambient_top = 0.5;
  options.ambient_bottom = 1;
  const Simulator simulator(scene, options);
  const SimulatedFrame lit = simulator.simulate(0);
  const auto in_light = [](const ImageF& image) { return image.block(60, 40, 60, 80); };
  EXPECT_EQ((lit.frame.phases[0] != dark.frame.phases[0]).count(),
            (in_light(lit.frame.phases[0]) != in_light(dark.frame.phases[0])).count())
      << "noise changed outside";
  for (const bool of_a : {true, false}) {
    const auto rms_m = [&](const SimulatedFrame& simulated) {
      const Frame& frame = simulated.frame;
      const Modulation& modulation = simulator.sensor().modulation;
      const ImageF error_m =
          test::range_error_m(of_a ? frame.phases[0] : frame.phases[1], simulated.range_truth_m,
                              of_a ? modulation.wavelength_m(0) : modulation.wavelength_m(1));
      return std::sqrt(double{in_light(error_m).square().mean()});
    };
    // The same draws, five times as large: only the second order differs.
    EXPECT_NEAR(rms_m(lit) / rms_m(dark), 5, 0.05);
  }
}

TEST(PhaseBits, RoundPhasesToSoManyLevelsACycle) {
  const Scene scene = test::facing_wall_scene(3, 0.5);
  const SimulatedFrame fine = Simulator(scene, short_waves()).simulate(0);
  for (const int bits : {4, 8, 12, 16}) {
    SimulatorOptions options = short_waves();
    options.phase_bits = bits;
    const SimulatedFrame coarse = Simulator(scene, options).simulate(0);
    const auto levels = static_cast<float>(1 << bits);
    for (const auto& [phase, exact] : {std::pair(coarse.frame.phases[0], fine.frame.phases[0]),
                                       std::pair(coarse.frame.phases[1], fine.frame.phases[1])}) {
      EXPECT_TRUE((phase * levels == (phase * levels).round()).all()) << bits;
      EXPECT_LT(phase.maxCoeff(), 1);
      const ImageF off = phase - exact - (phase - exact).round();
      EXPECT_LE(off.abs().maxCoeff(), 0.5F / levels + 1e-7F) << bits;
      EXPECT_GT(off.abs().maxCoeff(), 0.4F / levels) << bits;
    }
  }
}

TEST(Labels, AreThoseOfThePixelWithoutItsSystematicErrors) {
  SimulatorOptions options = test::ideal_camera();
  options.subpixels = 4;
  const ImageU8 plain = Simulator(test::edge_scene(0.015), options).simulate(0).label;
  ASSERT_GT((plain == static_cast<std::uint8_t>(PixelLabel::flying)).count(), 5);
  options.offset_a_m = 0.2;
  options.periodic_a_m = 0.1;
  options.amplitude_error_a_m = 0.05;
  options.fixed_pattern_m = 0.02;
  options.phase_bits = 4;
  EXPECT_TRUE((Simulator(test::edge_scene(0.015), options).simulate(0).label == plain).all());
}

TEST(SystematicErrors, RefuseWhatHasNoEffect) {
  const auto complaint = [](const SimulatorOptions& options) -> std::string {
    try {
      const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "none";
  };
  SimulatorOptions options = test::ideal_camera();
  options.phase_bits = 3;
  EXPECT_NE(complaint(options).find("simulator.phase_bits"), std::string::npos);
  options.phase_bits = 4;
  EXPECT_EQ(complaint(options), "none");
  options.ambient_noise = 2;
  options.ambient_left = 1;
  EXPECT_NE(complaint(options).find("simulator.ambient_left"), std::string::npos);
}

}  // namespace
}  // namespace tofmap
