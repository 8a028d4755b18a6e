// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/frame_pairing.hpp"

#include <cmath>
#include <utility>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Largest number of images of a stream that wait for their counterparts. The counterpart of an
/// image that more images have overtaken will not arrive.
constexpr std::size_t most_waiting = 8;

/// Number of recent keys that are kept to distinguish duplicates from late images.
constexpr std::size_t most_recent = 64;

/// Largest difference between the time from one image to the next and a whole number of periods, in
/// periods. With a larger difference the number of periods is uncertain.
constexpr double most_period_error = 1.0 / 3;

Half other(Half half) { return half == Half::a ? Half::b : Half::a; }

int images_in(const JoinedImages& joined) { return joined.has_amplitude() ? 2 : 1; }

}  // namespace

void StreamJoiner::count_lost(std::int64_t key, PairingCounts& counts) {
  if (key_ == ImageKey::time) return;
  if (!highest_key_ || key > *highest_key_) {
    if (highest_key_) counts.lost += static_cast<int>(key - *highest_key_ - 1);
    highest_key_ = key;
  } else if (!range_.recent_keys.contains(key) && !amplitude_.recent_keys.contains(key)) {
    --counts.lost;  // the image was not lost, but late
  }
}

bool StreamJoiner::is_in_order(Stream& stream, std::int64_t key, PairingCounts& counts) {
  const bool is_new = stream.recent_keys.insert(key).second;
  if (stream.recent_keys.size() > most_recent) {
    stream.recent_keys.erase(stream.recent_keys.begin());
  }
  if (!stream.last_key || key > *stream.last_key) {
    stream.last_key = key;
    return true;
  }
  ++(is_new ? counts.out_of_order : counts.duplicates);
  return false;
}

void StreamJoiner::drop_before(Stream& stream, std::int64_t key, PairingCounts& counts) {
  while (!stream.waiting.empty() && stream.waiting.front().key < key) {
    stream.waiting.pop_front();
    ++counts.half_missing;
  }
}

std::optional<JoinedImages> StreamJoiner::add(DeviceImage image, PairingCounts& counts) {
  const bool is_range = image.stream == DeviceStream::range;
  Stream& own = is_range ? range_ : amplitude_;
  Stream& others = is_range ? amplitude_ : range_;
  count_lost(image.key, counts);
  if (!is_in_order(own, image.key, counts)) return std::nullopt;
  if (!has_amplitude_) {
    ++counts.paired;
    return JoinedImages{image.timestamp_s, image.key, std::move(image.pixels), {}};
  }
  // Both streams are in order, so no counterpart will arrive for the other stream's earlier images.
  drop_before(others, image.key, counts);
  if (others.waiting.empty() || others.waiting.front().key != image.key) {
    own.waiting.push_back(std::move(image));
    if (own.waiting.size() > most_waiting) {
      own.waiting.pop_front();
      ++counts.half_missing;
    }
    return std::nullopt;
  }
  drop_before(own, image.key, counts);
  counts.paired += 2;
  DeviceImage partner = std::move(others.waiting.front());
  others.waiting.pop_front();
  DeviceImage& range = is_range ? image : partner;
  DeviceImage& amplitude = is_range ? partner : image;
  return JoinedImages{range.timestamp_s, range.key, std::move(range.pixels),
                      std::move(amplitude.pixels)};
}

void StreamJoiner::finish(PairingCounts& counts) {
  counts.half_missing += static_cast<int>(range_.waiting.size() + amplitude_.waiting.size());
  range_.waiting.clear();
  amplitude_.waiting.clear();
}

AlternatingPairer::AlternatingPairer(const Settings& settings) : settings_(settings) {
  if (!(settings.period_s > 0)) throw UsageError("the period between two images must be above 0 s");
}

std::optional<Half> AlternatingPairer::half_of(double timestamp_s, bool reaches_beyond,
                                               PairingCounts& counts) const {
  std::optional<Half> expected;
  if (!last_timestamp_s_) {
    expected = settings_.first;
  } else {
    const double periods = (timestamp_s - *last_timestamp_s_) / settings_.period_s;
    const double whole = std::round(periods);
    if (whole > 1) counts.lost += static_cast<int>(whole) - 1;
    if (last_half_ && std::abs(periods - whole) < most_period_error) {
      expected = std::fmod(whole, 2) == 0 ? *last_half_ : other(*last_half_);
    }
  }
  if (reaches_beyond) return settings_.longer;
  return expected;
}

void AlternatingPairer::drop_waiting(PairingCounts& counts) {
  if (!waiting_a_) return;
  counts.paired -= images_in(*waiting_a_);
  counts.half_missing += images_in(*waiting_a_);
  waiting_a_.reset();
}

std::optional<AlternatingPair> AlternatingPairer::add(JoinedImages images, bool reaches_beyond,
                                                      PairingCounts& counts) {
  const std::optional<Half> half = half_of(images.timestamp_s, reaches_beyond, counts);
  const bool follows =
      last_timestamp_s_ && std::abs(images.timestamp_s - *last_timestamp_s_ - settings_.period_s) <
                               most_period_error * settings_.period_s;
  last_timestamp_s_ = images.timestamp_s;
  last_half_ = half;
  if (half == Half::b && waiting_a_ && follows) {
    AlternatingPair pair{std::move(*waiting_a_), std::move(images)};
    waiting_a_.reset();
    return pair;
  }
  drop_waiting(counts);
  if (half == Half::a) {
    waiting_a_ = std::move(images);
    return std::nullopt;
  }
  counts.paired -= images_in(images);
  (half ? counts.half_missing : counts.undecided) += images_in(images);
  return std::nullopt;
}

void AlternatingPairer::finish(PairingCounts& counts) { drop_waiting(counts); }

}  // namespace tofmap
