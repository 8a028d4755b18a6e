// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/frame_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <tofmap/core/error.hpp>
#include <tofmap/core/modulation.hpp>

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

AlternatingJoiner::AlternatingJoiner(Settings settings) : settings_(std::move(settings)) {
  const std::vector<double>& wavelengths_m = settings_.wavelengths_m;
  if (!(settings_.period_s > 0))
    throw UsageError("the period between two images must be above 0 s");
  if (wavelengths_m.empty()) throw UsageError("images in turn need a frequency");
  if (settings_.first.value_or(0) >= wavelengths_m.size()) {
    throw UsageError("the first image cannot be of frequency " + frequency_name(*settings_.first) +
                     " of " + std::to_string(wavelengths_m.size()) + "; change device.first");
  }
  longest_m_ = std::ranges::max(wavelengths_m);
}

/// Whether an image whose ranges exceed the wavelength `beyond_m` can be of this frequency. The
/// longest wavelength is always possible: some ranges of damaged images exceed all.
bool AlternatingJoiner::is_possible(std::size_t frequency, double beyond_m) const {
  const double wavelength_m = settings_.wavelengths_m[frequency];
  return wavelength_m > beyond_m || wavelength_m == longest_m_;
}

/// The frequency of an image by its time. Counts the instants that were lost before it.
std::optional<std::size_t> AlternatingJoiner::expected(double timestamp_s,
                                                       PairingCounts& counts) const {
  if (!last_timestamp_s_) return settings_.first;
  const double periods = (timestamp_s - *last_timestamp_s_) / settings_.period_s;
  const double whole = std::round(periods);
  if (whole > 1) counts.lost += static_cast<int>(whole) - 1;
  if (!last_frequency_ || std::abs(periods - whole) >= most_period_error) return std::nullopt;
  const auto frequencies = static_cast<double>(settings_.wavelengths_m.size());
  const double last = static_cast<double>(*last_frequency_);
  return static_cast<std::size_t>(std::fmod(last + std::fmod(whole, frequencies), frequencies));
}

/// The expected frequency if the content admits it; else the only one that it admits, if there is
/// only one.
std::optional<std::size_t> AlternatingJoiner::frequency_of(std::optional<std::size_t> expected,
                                                           double beyond_m) const {
  if (expected && is_possible(*expected, beyond_m)) return expected;
  std::optional<std::size_t> only;
  for (std::size_t f = 0; f < settings_.wavelengths_m.size(); ++f) {
    if (!is_possible(f, beyond_m)) continue;
    if (only) return std::nullopt;
    only = f;
  }
  return only;
}

void AlternatingJoiner::drop_waiting(PairingCounts& counts) {
  for (const JoinedImages& images : waiting_) {
    counts.paired -= images_in(images);
    counts.half_missing += images_in(images);
  }
  waiting_.clear();
}

std::vector<JoinedImages> AlternatingJoiner::add(JoinedImages images, double beyond_m,
                                                 PairingCounts& counts) {
  const std::optional<std::size_t> frequency =
      frequency_of(expected(images.timestamp_s, counts), beyond_m);
  const bool follows =
      last_timestamp_s_ && std::abs(images.timestamp_s - *last_timestamp_s_ - settings_.period_s) <
                               most_period_error * settings_.period_s;
  last_timestamp_s_ = images.timestamp_s;
  last_frequency_ = frequency;
  if (!follows || frequency != waiting_.size()) drop_waiting(counts);
  if (frequency != waiting_.size()) {
    counts.paired -= images_in(images);
    (frequency ? counts.half_missing : counts.undecided) += images_in(images);
    return {};
  }
  waiting_.push_back(std::move(images));
  if (waiting_.size() < settings_.wavelengths_m.size()) return {};
  return std::exchange(waiting_, {});
}

void AlternatingJoiner::finish(PairingCounts& counts) { drop_waiting(counts); }

}  // namespace tofmap
