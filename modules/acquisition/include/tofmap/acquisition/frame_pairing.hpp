// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <vector>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// What became of the images that a device delivered. After finish(), each image that arrived is
/// counted in exactly one of `paired` … `undecided`.
struct PairingCounts {
  int paired = 0;        ///< images that became part of a frame
  int half_missing = 0;  ///< images whose counterpart did not arrive
  int duplicates = 0;    ///< images that arrived a second time
  int out_of_order = 0;  ///< images that arrived after a later image of the same stream
  int unreadable = 0;    ///< images of a wrong size, or whose tag is damaged or does not match
  int undecided = 0;     ///< images that could be of several frequencies
  int lost = 0;          ///< instants without any image, by gaps in the numbers or times

  /// Number of images that arrived but did not become part of a frame.
  int dropped() const { return half_missing + duplicates + out_of_order + unreadable + undecided; }
};

/// The stream that delivered an image: depth (`range`) or infrared (`amplitude`).
enum class DeviceStream : std::uint8_t { range, amplitude };

/// The kind of DeviceImage::key. A later instant has a larger key.
enum class ImageKey : std::uint8_t {
  number,  ///< counts instants without gaps
  time,    ///< a time in any unit
};

/// An image as a device delivers it.
struct DeviceImage {
  DeviceStream stream = DeviceStream::range;
  double timestamp_s = 0;  ///< by the device's clock
  std::int64_t key = 0;    ///< identifies the instant; equal for the images of one instant
  ImageU16 pixels;
};

/// The range image and the amplitude image of one instant.
struct JoinedImages {
  double timestamp_s = 0;  ///< by the device's clock
  std::int64_t key = 0;    ///< DeviceImage::key
  ImageU16 range;
  ImageU16 amplitude;  ///< empty (0 x 0) if the device delivers no amplitudes

  bool has_amplitude() const { return amplitude.size() > 0; }
};

/// Joins the range images and amplitude images of a device by their keys. Images of different
/// instants are never joined. Images that arrive out of order, twice, or without their counterpart
/// are dropped and counted.
class StreamJoiner {
 public:
  /// `has_amplitude` false: the device delivers range images only, which are passed on in order.
  StreamJoiner(ImageKey key, bool has_amplitude) : key_(key), has_amplitude_(has_amplitude) {}

  /// Adds an image. Returns the images of an instant if this image completes them, else nothing.
  std::optional<JoinedImages> add(DeviceImage image, PairingCounts& counts);

  /// Drops and counts the images that still wait for their counterpart. Call at the end of the
  /// streams.
  void finish(PairingCounts& counts);

 private:
  struct Stream {
    std::deque<DeviceImage> waiting;
    std::optional<std::int64_t> last_key;
    std::set<std::int64_t> recent_keys;
  };
  void count_lost(std::int64_t key, PairingCounts& counts);
  static bool is_in_order(Stream& stream, std::int64_t key, PairingCounts& counts);
  static void drop_before(Stream& stream, std::int64_t key, PairingCounts& counts);

  ImageKey key_;
  bool has_amplitude_;
  std::optional<std::int64_t> highest_key_;
  Stream range_;
  Stream amplitude_;
};

/// Makes frames of the images of a device that delivers one frequency after another: the image of
/// the first frequency and those that follow it, one of each frequency.
///
/// The number of periods since the previous image tells of which frequency an image is. The content
/// overrules it: an image with ranges beyond a wavelength is of a longer wavelength. At the
/// beginning, unless Settings::first is set, and after a time difference that is not close to a
/// whole number of periods, only the content can decide; until a single frequency is possible,
/// images are dropped.
class AlternatingJoiner {
 public:
  struct Settings {
    double period_s = 0;                ///< time between two images; above 0
    std::vector<double> wavelengths_m;  ///< of each frequency, in the order of the images
    std::optional<std::size_t> first;   ///< the frequency of the first image, from 0; empty:
                                        ///< unknown, the content decides
  };

  /// Throws UsageError unless the period is above 0, there is a wavelength, and the first image is
  /// of one of the frequencies.
  explicit AlternatingJoiner(Settings settings);

  /// Adds the images of the next instant. `beyond_m` is the longest of the wavelengths that their
  /// ranges exceed, 0 if they exceed none. Returns the images of one frame, one JoinedImages for
  /// each frequency, if these complete it, else nothing.
  std::vector<JoinedImages> add(JoinedImages images, double beyond_m, PairingCounts& counts);

  /// Drops and counts images that still wait for those of the other frequencies. Call at the end
  /// of the streams.
  void finish(PairingCounts& counts);

 private:
  bool is_possible(std::size_t frequency, double beyond_m) const;
  std::optional<std::size_t> expected(double timestamp_s, PairingCounts& counts) const;
  std::optional<std::size_t> frequency_of(std::optional<std::size_t> expected,
                                          double beyond_m) const;
  void drop_waiting(PairingCounts& counts);

  Settings settings_;
  double longest_m_ = 0;
  std::vector<JoinedImages> waiting_;  ///< of the first frequencies of a frame
  std::optional<double> last_timestamp_s_;
  std::optional<std::size_t> last_frequency_;
};

}  // namespace tofmap
