// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/frame_pairing.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// An image whose content says of which instant it is.
DeviceImage image_of(int instant, DeviceStream stream) {
  return {stream, 0.1 * instant, instant,
          ImageU16::Constant(1, 1, static_cast<std::uint16_t>(instant))};
}

TEST(StreamJoiner, JoinsTheImagesOfOneInstant) {
  StreamJoiner joiner(ImageKey::number, true);
  PairingCounts counts;
  for (int i = 0; i < 10; ++i) {
    const bool range_first = i % 2 == 0;
    const auto first = range_first ? DeviceStream::range : DeviceStream::amplitude;
    const auto second = range_first ? DeviceStream::amplitude : DeviceStream::range;
    EXPECT_FALSE(joiner.add(image_of(i, first), counts));
    const auto joined = joiner.add(image_of(i, second), counts);
    ASSERT_TRUE(joined);
    EXPECT_EQ(joined->range(0, 0), i);
    EXPECT_EQ(joined->amplitude(0, 0), i);
    EXPECT_EQ(joined->timestamp_s, 0.1 * i);
  }
  EXPECT_EQ(counts.paired, 20);
  EXPECT_EQ(counts.dropped(), 0);
}

TEST(StreamJoiner, PassesRangesOnWhereThereAreNoAmplitudes) {
  StreamJoiner joiner(ImageKey::time, false);
  PairingCounts counts;
  EXPECT_TRUE(joiner.add(image_of(3, DeviceStream::range), counts));
  EXPECT_FALSE(joiner.add(image_of(3, DeviceStream::range), counts));
  EXPECT_FALSE(joiner.add(image_of(2, DeviceStream::range), counts));
  const auto last = joiner.add(image_of(9, DeviceStream::range), counts);
  ASSERT_TRUE(last);
  EXPECT_FALSE(last->has_amplitude());
  EXPECT_EQ(counts.paired, 2);
  EXPECT_EQ(counts.duplicates, 1);
  EXPECT_EQ(counts.out_of_order, 1);
}

TEST(StreamJoiner, CountsWhatWaitsInVain) {
  StreamJoiner joiner(ImageKey::number, true);
  PairingCounts counts;
  constexpr int many = 30;
  for (int i = 0; i < many; ++i) joiner.add(image_of(i, DeviceStream::range), counts);
  EXPECT_GT(counts.half_missing, 0) << "it does not wait for ever";
  joiner.finish(counts);
  EXPECT_EQ(counts.half_missing, many);
}

TEST(StreamJoiner, CountsInstantsOfWhichNothingCame) {
  StreamJoiner joiner(ImageKey::number, true);
  PairingCounts counts;
  for (const int i : {10, 11, 15, 16}) {
    joiner.add(image_of(i, DeviceStream::range), counts);
    joiner.add(image_of(i, DeviceStream::amplitude), counts);
  }
  EXPECT_EQ(counts.lost, 3);
  joiner.add(image_of(13, DeviceStream::range), counts);  // late, so not lost
  EXPECT_EQ(counts.lost, 2);
  EXPECT_EQ(counts.out_of_order, 1);
}

/// What may happen to images on their way.
struct Faults {
  double lose = 0;
  double repeat = 0;
  double swap = 0;  ///< with the one after it
};

/// What of `images` arrives.
template <class Item>
std::vector<Item> with_faults(const std::vector<Item>& images, const Faults& faults,
                              std::mt19937& random) {
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<Item> arriving;
  for (const Item& image : images) {
    if (chance(random) < faults.lose) continue;
    arriving.push_back(image);
    if (chance(random) < faults.repeat) arriving.push_back(image);
  }
  for (std::size_t i = 1; i < arriving.size(); ++i) {
    if (chance(random) < faults.swap) std::swap(arriving[i - 1], arriving[i]);
  }
  return arriving;
}

class UnderFaults : public testing::TestWithParam<int> {
 protected:
  static constexpr int instants = 2000;

  Faults faults() const {
    std::mt19937 random(static_cast<unsigned>(GetParam()));
    std::uniform_real_distribution<double> share(0, 0.2);
    return {share(random), share(random), share(random)};
  }
};

TEST_P(UnderFaults, StreamsAreJoinedRightAndEveryImageIsCounted) {
  std::mt19937 random(100U + static_cast<unsigned>(GetParam()));
  std::vector<DeviceImage> sent;
  for (int i = 0; i < instants; ++i) {
    sent.push_back(image_of(i, DeviceStream::range));
    sent.push_back(image_of(i, DeviceStream::amplitude));
  }
  const std::vector<DeviceImage> arriving = with_faults(sent, faults(), random);
  StreamJoiner joiner(ImageKey::number, true);
  PairingCounts counts;
  int last = -1;
  int joined_count = 0;
  for (const DeviceImage& image : arriving) {
    const auto joined = joiner.add(image, counts);
    if (!joined) continue;
    ++joined_count;
    EXPECT_EQ(joined->range(0, 0), joined->amplitude(0, 0)) << "of two instants";
    EXPECT_GT(joined->key, last);
    last = static_cast<int>(joined->key);
  }
  joiner.finish(counts);
  EXPECT_EQ(counts.paired, 2 * joined_count);
  EXPECT_EQ(counts.paired + counts.dropped(), static_cast<int>(arriving.size()));

  std::vector<bool> came(instants, false);
  for (const DeviceImage& image : arriving) came[static_cast<std::size_t>(image.key)] = true;
  const auto first = std::ranges::find(came, true);
  const auto end = std::ranges::find(came.rbegin(), came.rend(), true).base();
  EXPECT_EQ(counts.lost, std::count(first, end, false));
}

/// One image of a device that takes A at even instants and B at odd ones. A, of the longer
/// wavelength, reaches beyond the shorter one in nine images out of ten.
struct Taken {
  int instant = 0;
  bool reaches_beyond = false;
};

std::vector<Taken> take_in_turn(int instants, std::mt19937& random) {
  std::uniform_real_distribution<double> chance(0, 1);
  std::vector<Taken> taken;
  for (int i = 0; i < instants; ++i) taken.push_back({i, i % 2 == 0 && chance(random) < 0.9});
  return taken;
}

JoinedImages joined_of(const Taken& taken, double jitter_s) {
  JoinedImages images;
  images.timestamp_s = 5 + 0.05 * taken.instant + jitter_s;
  images.key = taken.instant;
  images.range = ImageU16::Constant(1, 1, static_cast<std::uint16_t>(taken.instant));
  return images;
}

/// A has the longer wavelength.
const AlternatingJoiner::Settings in_turn{
    .period_s = 0.05, .wavelengths_m = {5.2, 4.8}, .first = {}};

/// The wavelength that the ranges of an image exceed.
double beyond_m(bool reaches_beyond) { return reaches_beyond ? 4.8 : 0; }

TEST_P(UnderFaults, ImagesTakenInTurnArePairedRightAndEveryOneIsCounted) {
  std::mt19937 random(200U + static_cast<unsigned>(GetParam()));
  std::uniform_real_distribution<double> jitter_s(-0.005, 0.005);
  Faults loss = faults();
  loss.repeat = loss.swap = 0;  // what arrives is in order: StreamJoiner sees to that
  const auto arriving = with_faults(take_in_turn(instants, random), loss, random);
  AlternatingJoiner joiner(in_turn);
  PairingCounts counts;
  int pairs = 0;
  for (const Taken& taken : arriving) {
    ++counts.paired;  // as the joiner counts
    const auto pair =
        joiner.add(joined_of(taken, jitter_s(random)), beyond_m(taken.reaches_beyond), counts);
    if (pair.empty()) continue;
    ++pairs;
    EXPECT_EQ(pair[0].key % 2, 0);
    EXPECT_EQ(pair[1].key, pair[0].key + 1);
  }
  joiner.finish(counts);
  EXPECT_EQ(counts.paired, 2 * pairs);
  EXPECT_EQ(counts.paired + counts.dropped(), static_cast<int>(arriving.size()));
  EXPECT_EQ(counts.lost, 1 + arriving.back().instant - arriving.front().instant -
                             static_cast<int>(arriving.size()));
  // No whole pair is given away, but for those before content has told which is which.
  int whole = 0;
  for (std::size_t i = 1; i < arriving.size(); ++i) {
    whole += arriving[i].instant % 2 == 1 && arriving[i - 1].instant == arriving[i].instant - 1;
  }
  EXPECT_GE(pairs, whole - 3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, UnderFaults, testing::Range(0, 8));

TEST(AlternatingJoiner, DoesNotGuessWhichIsWhich) {
  AlternatingJoiner joiner(in_turn);
  PairingCounts counts;
  for (int i = 0; i < 20; ++i)
    EXPECT_THAT(joiner.add(joined_of({i, false}, 0), 0, counts), IsEmpty());
  EXPECT_EQ(counts.undecided, 20);
}

TEST(AlternatingJoiner, BelievesContentMoreThanWhatItWasTold) {
  AlternatingJoiner::Settings wrong = in_turn;
  wrong.first = 1;  // but instant 0 is A
  AlternatingJoiner joiner(wrong);
  PairingCounts counts;
  for (int i = 0; i < 20; ++i) {
    const auto pair = joiner.add(joined_of({i, false}, 0), beyond_m(i % 2 == 0), counts);
    EXPECT_EQ(pair.size(), i % 2 == 1 ? 2U : 0U);
    EXPECT_TRUE(pair.empty() || pair[0].key % 2 == 0);
  }
}

TEST(AlternatingJoiner, TakesWhatItWasToldWhereContentDoesNotTell) {
  AlternatingJoiner::Settings told = in_turn;
  told.first = 0;
  AlternatingJoiner joiner(told);
  PairingCounts counts;
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(joiner.add(joined_of({i, false}, 0), 0, counts).size(), i % 2 == 1 ? 2U : 0U);
  }
}

TEST(AlternatingJoiner, StartsAnewWhereTimesDoNotTellHowManyPeriodsHavePassed) {
  AlternatingJoiner::Settings told = in_turn;
  told.first = 0;
  AlternatingJoiner joiner(told);
  PairingCounts counts;
  joiner.add(joined_of({0, false}, 0), 0, counts);
  EXPECT_THAT(joiner.add(joined_of({1, false}, 0.02), 0, counts), IsEmpty()) << "1.4 periods later";
  EXPECT_THAT(joiner.add(joined_of({2, false}, 0), 0, counts), IsEmpty());
  EXPECT_EQ(counts.undecided, 2);
  EXPECT_THAT(joiner.add(joined_of({4, false}, 0), beyond_m(true), counts), IsEmpty())
      << "A's, as content tells";
  EXPECT_EQ(joiner.add(joined_of({5, false}, 0), 0, counts).size(), 2U);
}

TEST(AlternatingJoiner, KnowsEightFrequenciesByTheOneThatContentTells) {
  AlternatingJoiner::Settings eight{.period_s = 0.05, .wavelengths_m = {}, .first = {}};
  for (int f = 0; f < 8; ++f) eight.wavelengths_m.push_back(f == 5 ? 9 : 1 + 0.1 * f);
  AlternatingJoiner joiner(eight);
  PairingCounts counts;
  int frames = 0;
  for (int i = 3; i < 40; ++i) {  // the first image is of the fourth frequency
    ++counts.paired;
    // Instant 29 shows ranges beyond all wavelengths but the longest; the others tell nothing.
    const auto images = joiner.add(joined_of({i, false}, 0), i == 29 ? 1.75 : 0, counts);
    if (images.empty()) continue;
    ++frames;
    ASSERT_EQ(images.size(), 8U);
    for (std::size_t f = 0; f < 8; ++f)
      EXPECT_EQ(images[f].key, images[0].key + static_cast<int>(f));
    EXPECT_EQ(images[0].key % 8, 0);
  }
  EXPECT_EQ(frames, 1) << "32 … 39";
  EXPECT_EQ(counts.undecided, 26) << "3 … 28";
  EXPECT_EQ(counts.half_missing, 3) << "29 … 31";
  EXPECT_EQ(counts.paired, 8);
}

TEST(AlternatingJoiner, IsNotToldByContentThatSeveralFrequenciesMayHave) {
  AlternatingJoiner::Settings three{
      .period_s = 0.05, .wavelengths_m = {1.87, 9.37, 2.5}, .first = {}};
  AlternatingJoiner joiner(three);
  PairingCounts counts;
  for (int i = 0; i < 6; ++i) {
    EXPECT_THAT(joiner.add(joined_of({i, false}, 0), 1.87, counts), IsEmpty());
  }
  EXPECT_EQ(counts.undecided, 6) << "of 9.37 m or 2.5 m";
}

TEST(AlternatingJoiner, DropsAFrameOfWhichOneImageIsLost) {
  AlternatingJoiner::Settings three{
      .period_s = 0.05, .wavelengths_m = {1.87, 9.37, 1.25}, .first = 0};
  AlternatingJoiner joiner(three);
  PairingCounts counts;
  std::vector<std::int64_t> first_keys;
  for (const int i : {0, 1, 2, 3, 5, 6, 7, 8, 10, 11}) {  // 4 and 9 are lost
    ++counts.paired;
    const auto images = joiner.add(joined_of({i, false}, 0), i % 3 == 1 ? 1.87 : 0, counts);
    if (!images.empty()) first_keys.push_back(images[0].key);
  }
  EXPECT_THAT(first_keys, ElementsAre(0, 6));
  EXPECT_EQ(counts.half_missing, 4) << "3, 5, 10 and 11";
  EXPECT_EQ(counts.lost, 2);
}

TEST(AlternatingJoiner, MakesAFrameOfEachImageOfASingleFrequency) {
  AlternatingJoiner joiner({.period_s = 0.05, .wavelengths_m = {5.2}, .first = {}});
  PairingCounts counts;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(joiner.add(joined_of({i, false}, 0), 0, counts).size(), 1U);
}

TEST(AlternatingJoiner, NeedsAPeriodAndAFirstImageOfOneOfItsFrequencies) {
  AlternatingJoiner::Settings none = in_turn;
  none.period_s = 0;
  EXPECT_THROW(AlternatingJoiner{none}, UsageError);
  AlternatingJoiner::Settings third = in_turn;
  third.first = 2;
  EXPECT_THROW(AlternatingJoiner{third}, UsageError);
  EXPECT_THROW(AlternatingJoiner({.period_s = 0.05, .wavelengths_m = {}, .first = {}}), UsageError);
}

}  // namespace
}  // namespace tofmap
