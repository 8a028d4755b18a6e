// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

const Modulation paper{29e6, 31e6};
const Modulation kinect{80e6, 100e6};

TEST(Wavelength, IsHalfTheWayLightGoesInAPeriod) {
  EXPECT_NEAR(paper.wavelength_m(0), 5.16883548, 1e-8);
  EXPECT_NEAR(paper.wavelength_m(1), 4.83536223, 1e-8);
}

TEST(MeanWavelength, TellsTheNoiseOfAMeanOfRanges) {
  EXPECT_NEAR(mean_wavelength_m({30e6}), 4.9965, 1e-4);
  // Inverse variances of both ranges, with a phase noise of one cycle.
  const double inverse = 1 / std::pow(5.16883548, 2) + 1 / std::pow(4.83536223, 2);
  EXPECT_NEAR(std::pow(mean_wavelength_m(paper), -2), inverse, 1e-9);
}

TEST(CombinedRange, IsThatOfTheGreatestCommonDivisor) {
  const double c = speed_of_light_m_per_s;
  EXPECT_NEAR(combined_range_m(paper), c / 2 / 1e6, 1e-6);
  EXPECT_NEAR(combined_range_m(kinect), c / 2 / 20e6, 1e-6);
}

TEST(CombinedRange, EndsSoonerWherePhasesAreNoisy) {
  // After 14 wraps of A, B has turned 14.966 times: 0.034 cycles from whole.
  EXPECT_NEAR(combined_range_m(paper, 0.05), 14 * paper.wavelength_m(0), 1e-9);
}

TEST(CombinedRange, IsTheSameWhicheverIsLonger) {
  EXPECT_EQ(combined_range_m({31e6, 29e6}), combined_range_m(paper));
  EXPECT_EQ(combined_range_m({31e6, 29e6}, 0.05), combined_range_m(paper, 0.05));
}

TEST(CombinedRange, OfAPairWithoutCommonDivisorIsFinite) {
  const Modulation odd{29e6, 29e6 * std::sqrt(2.0)};
  const double range_m = combined_range_m(odd);
  EXPECT_GT(range_m, odd.wavelength_m(0));
  EXPECT_LE(range_m, 1000 * odd.wavelength_m(0));
}

TEST(WrapLimits, CountTheWavelengthsBegun) {
  EXPECT_EQ(wrap_limit(paper.wavelength_m(0), 5.0), 1);
  EXPECT_EQ(wrap_limit(paper.wavelength_m(1), 5.0), 2);
  EXPECT_EQ(wrap_limit(paper.wavelength_m(0), 25.0), 5);
  EXPECT_EQ(wrap_limit(paper.wavelength_m(1), 25.0), 6);
}

TEST(WrapLimits, OfAWholeNumberOfWavelengthsAreThatNumber) {
  EXPECT_EQ(wrap_limit(paper.wavelength_m(0), 3 * paper.wavelength_m(0)), 3);
  EXPECT_EQ(wrap_limit(paper.wavelength_m(0), combined_range_m(paper)), 29);
  EXPECT_EQ(wrap_limit(paper.wavelength_m(1), combined_range_m(paper)), 31);
}

TEST(WrapLimits, NeedAPositiveRange) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(wrap_limit(paper.wavelength_m(0), bad), UsageError) << bad;
  }
}

TEST(ModulationValidation, RefusesEqualFrequenciesAndTellsWhy) {
  try {
    validate(Modulation{30e6, 30e6});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("different frequencies"), std::string::npos);
  }
}

TEST(ModulationValidation, AsksForHertzWhereFrequenciesAreNoCameras) {
  for (const Modulation& wrong :
       {Modulation{29, 31}, Modulation{29e6, 31}, Modulation{29e12, 31e12}}) {
    try {
      validate(wrong);
      FAIL() << wrong.frequencies_hz[0];
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("in hertz"));
    }
  }
}

TEST(ModulationValidation, RefusesWhatIsNoFrequency) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(Modulation{0, 31e6}), InputError);
  EXPECT_THROW(validate(Modulation{29e6, -31e6}), InputError);
  EXPECT_THROW(validate(Modulation{nan, 31e6}), InputError);
}

TEST(ModulationValidation, RefusesAFrequencyThatIsNotFinite) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Modulation& wrong : {Modulation{infinite, 31e6}, Modulation{29e6, infinite}}) {
    try {
      validate(wrong);
      FAIL() << "accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("must be positive"));
    }
  }
}

TEST(ModulationValidation, NeedsFrequenciesToDifferByAMillionth) {
  EXPECT_THROW(validate(Modulation{29e6, 29e6 * (1 + 0.9e-6)}), InputError);
  EXPECT_THROW(validate(Modulation{29e6, 29e6 * (1 - 0.9e-6)}), InputError);
  EXPECT_NO_THROW(validate(Modulation{29e6, 29e6 * (1 + 1.1e-6)}));
}

TEST(ModulationValidation, TakesEitherOrder) {
  EXPECT_NO_THROW(validate(paper));
  EXPECT_NO_THROW(validate(Modulation{31e6, 29e6}));
}

TEST(CombinedRange, OfThreeFrequenciesIsThatOfAllOfThem) {
  const Modulation three{80e6, 16e6, 120e6};
  EXPECT_NEAR(combined_range_m(three), speed_of_light_m_per_s / 2 / 8e6, 1e-6);
  EXPECT_NEAR(combined_range_m(three, 0.05), speed_of_light_m_per_s / 2 / 8e6, 1e-6);
  EXPECT_NEAR(combined_range_m({120e6, 16e6, 80e6}), combined_range_m(three), 1e-9);
}

TEST(CombinedRange, OfOneFrequencyIsItsWavelength) {
  EXPECT_DOUBLE_EQ(combined_range_m({30e6}), speed_of_light_m_per_s / 60e6);
}

TEST(ModulationValidation, TakesOneToEightFrequencies) {
  Modulation modulation{30e6};
  EXPECT_NO_THROW(validate(modulation));
  for (int i = 1; i < 8; ++i) modulation.frequencies_hz.push_back(30e6 + i * 1e6);
  EXPECT_NO_THROW(validate(modulation));
  modulation.frequencies_hz.push_back(60e6);
  EXPECT_THROW(validate(modulation), InputError);
  EXPECT_THROW(validate(Modulation()), InputError);
  EXPECT_THROW(validate(Modulation{80e6, 16e6, 80e6}), InputError) << "the first and the third";
}

TEST(Modulation, OrdersTheOtherFrequenciesByWavelength) {
  const auto others = [](const Modulation& modulation) {
    return others_by_wavelength(wavelengths_m(modulation));
  };
  EXPECT_EQ(others({80e6, 120e6, 16e6, 60e6}), (std::vector<std::size_t>{2, 3, 1}));
  EXPECT_EQ(others({29e6, 31e6}), std::vector<std::size_t>{1});
  EXPECT_TRUE(others({20e6}).empty());
}

TEST(ModulationValidation, NeedsAnExposureTimeOfEachFrequencyOrOfNone) {
  Modulation modulation{80e6, 16e6, 120e6};
  modulation.exposure_offsets_s = {0, 0.004};
  EXPECT_THROW(validate(modulation), InputError);
  modulation.exposure_offsets_s = {0, 0.004, 0.008};
  EXPECT_NO_THROW(validate(modulation));
  modulation.exposure_offsets_s[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(modulation), InputError);
}

}  // namespace
}  // namespace tofmap
