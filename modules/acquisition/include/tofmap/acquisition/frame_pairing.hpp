// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>

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
  int undecided = 0;     ///< images that could be of either frequency
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

/// One of the two images of a dual-frequency frame.
enum class Half : std::uint8_t { a, b };

/// The images of one dual-frequency frame of a device that delivers A and B alternately.
struct AlternatingPair {
  JoinedImages a;
  JoinedImages b;
};

/// Pairs the images of a device that delivers A and B alternately: each A with the B that follows
/// it.
///
/// The number of periods since the previous image tells whether an image is A or B. The content
/// overrules it: an image with ranges beyond the shorter wavelength is of the longer wavelength. At
/// the beginning, unless Settings::first is set, and after a time difference that is not close to a
/// whole number of periods, only the content can decide; until it does, images are dropped.
class AlternatingPairer {
 public:
  struct Settings {
    double period_s = 0;        ///< time between two images; above 0
    Half longer = Half::a;      ///< the image with the longer wavelength
    std::optional<Half> first;  ///< the first image; empty: unknown, the content decides
  };

  /// Throws UsageError unless the period is above 0.
  explicit AlternatingPairer(const Settings& settings);

  /// Adds the images of the next instant. `reaches_beyond` is true if they contain ranges beyond
  /// the shorter wavelength. Returns a pair if these images complete it, else nothing.
  std::optional<AlternatingPair> add(JoinedImages images, bool reaches_beyond,
                                     PairingCounts& counts);

  /// Drops and counts an image A that still waits for its B. Call at the end of the streams.
  void finish(PairingCounts& counts);

 private:
  std::optional<Half> half_of(double timestamp_s, bool reaches_beyond, PairingCounts& counts) const;
  void drop_waiting(PairingCounts& counts);

  Settings settings_;
  std::optional<JoinedImages> waiting_a_;
  std::optional<double> last_timestamp_s_;
  std::optional<Half> last_half_;
};

}  // namespace tofmap
