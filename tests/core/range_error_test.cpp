// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include <tofmap/core/range_error.hpp>

namespace tofmap {
namespace {

ImageF row_of(std::initializer_list<float> values) {
  ImageF image(1, static_cast<Eigen::Index>(values.size()));
  std::ranges::copy(values, image.data());
  return image;
}

TEST(PhaseSigma, IsTheScaleOverTheAmplitude) {
  const ImageF sigma =
      phase_sigma_cycles(row_of({0.1F, 0.5F, 0.9F}), row_of({10.0F, 100.0F, 0.5F}), 2);
  EXPECT_FLOAT_EQ(sigma(0, 0), 0.2F);
  EXPECT_FLOAT_EQ(sigma(0, 1), 0.02F);
  EXPECT_FLOAT_EQ(sigma(0, 2), 4.0F);
}

TEST(PhaseSigma, IsTheScaleItselfWithoutAmplitudes) {
  const ImageF sigma = phase_sigma_cycles(row_of({0.1F, 0.5F}), {}, 0.03);
  EXPECT_FLOAT_EQ(sigma(0, 0), 0.03F);
  EXPECT_FLOAT_EQ(sigma(0, 1), 0.03F);
}

TEST(PhaseSigma, GrowsWithAmbientLight) {
  const ImageF phase = row_of({0.1F, 0.5F});
  const ImageF amplitude = row_of({10.0F, 10.0F});
  const ImageF sigma = phase_sigma_cycles(phase, amplitude, 2, 0, row_of({1.0F, 5.0F}));
  EXPECT_FLOAT_EQ(sigma(0, 0), 0.2F);
  EXPECT_FLOAT_EQ(sigma(0, 1), 1.0F);
  EXPECT_FLOAT_EQ(phase_sigma_cycles(phase, {}, 0.03, 0, row_of({1.0F, 5.0F}))(0, 1), 0.15F);
}

TEST(PhaseSigma, HasTheRoundingOfItsStepOnTopWhateverTheLight) {
  const double step_cycles = 1.0 / 64;
  const ImageF sigma = phase_sigma_cycles(row_of({0.1F, 0.5F}), row_of({1e9F, 10.0F}), 0.1,
                                          step_cycles, row_of({1.0F, 3.0F}));
  // An even distribution over one step has the variance step² / 12.
  EXPECT_NEAR(sigma(0, 0), step_cycles / std::sqrt(12.0), 1e-7);
  EXPECT_NEAR(sigma(0, 1), std::hypot(0.1 * 3 / 10, step_cycles / std::sqrt(12.0)), 1e-7);
}

TEST(PhaseSigma, IsNaNWhereNothingWasMeasured) {
  const ImageF sigma = phase_sigma_cycles(row_of({NAN, 0.5F, 0.5F, 0.5F, 0.5F}),
                                          row_of({10.0F, 0.0F, -1.0F, NAN, 10.0F}), 2, 0.01);
  for (Eigen::Index u = 0; u < 4; ++u) EXPECT_TRUE(std::isnan(sigma(0, u))) << u;
  EXPECT_TRUE(std::isfinite(sigma(0, 4)));
  EXPECT_TRUE(std::isnan(phase_sigma_cycles(row_of({NAN}), {}, 2)(0, 0)));
}

TEST(PhaseSigma, OfAFrameHasEachFrequencyAtItsOwnAmplitudeScaleAndStep) {
  Frame frame = blank_frame(2);
  frame.phases[0] = row_of({0.1F, NAN});
  frame.phases[1] = row_of({0.2F, 0.3F});
  frame.amplitudes[0] = row_of({10.0F, 10.0F});
  frame.amplitudes[1] = row_of({20.0F, 40.0F});
  const std::vector<PhaseNoise> noise{{.scale = 1, .quantisation_cycles = 0},
                                      {.scale = 4, .quantisation_cycles = 0.5}};
  const PhaseSigma sigma(frame, noise, row_of({2.0F, 3.0F}));
  EXPECT_FLOAT_EQ(sigma.cycles[0](0, 0), 0.2F);
  EXPECT_TRUE(std::isnan(sigma.cycles[0](0, 1)));
  EXPECT_NEAR(sigma.cycles[1](0, 0), std::hypot(0.4, 0.5 / std::sqrt(12.0)), 1e-6);
  EXPECT_NEAR(sigma.cycles[1](0, 1), std::hypot(0.3, 0.5 / std::sqrt(12.0)), 1e-6);
}

TEST(PhaseSigma, OfAnEmptyImageIsEmpty) { EXPECT_EQ(phase_sigma_cycles({}, {}, 2, 0.1).size(), 0); }

}  // namespace
}  // namespace tofmap
