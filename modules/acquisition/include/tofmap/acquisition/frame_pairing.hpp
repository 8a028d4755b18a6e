// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <set>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// What became of the images that a device delivered. Every image that arrived is in one of
/// `paired` … `undecided`.
struct PairingCounts {
  int paired = 0;        ///< images that became part of a frame
  int half_missing = 0;  ///< their other half never came
  int duplicates = 0;
  int out_of_order = 0;  ///< later ones were there already
  int unreadable = 0;    ///< of a wrong size, or with a damaged tag
  int undecided = 0;     ///< nothing told whether they were A's or B's
  int lost = 0;          ///< instants of which no image came, as numbers or times tell

  /// Images that came and became part of no frame.
  int dropped() const { return half_missing + duplicates + out_of_order + unreadable + undecided; }
};

enum class DeviceStream : std::uint8_t { range, amplitude };

/// What tells the instants of images apart, and grows with them.
enum class ImageKey : std::uint8_t {
  number,  ///< counts instants without gaps
  time,    ///< in any unit
};

/// An image as a device delivers it.
struct DeviceImage {
  DeviceStream stream = DeviceStream::range;
  double timestamp_s = 0;  ///< by the device's clock
  std::int64_t key = 0;    ///< the same for images of one instant
  ImageU16 pixels;
};

/// The range and amplitude image of one instant.
struct JoinedImages {
  double timestamp_s = 0;
  std::int64_t key = 0;
  ImageU16 range;
  ImageU16 amplitude;  ///< empty (0 x 0) if the device has none

  bool has_amplitude() const { return amplitude.size() > 0; }
};

/// Joins the images of two streams by their keys. What arrives out of order, twice or without its
/// other half is dropped and counted: no two images of different instants are joined.
class StreamJoiner {
 public:
  /// Without amplitudes range images pass through, in order.
  StreamJoiner(ImageKey key, bool has_amplitude) : key_(key), has_amplitude_(has_amplitude) {}

  /// Takes an image, and returns what it completes.
  std::optional<JoinedImages> add(DeviceImage image, PairingCounts& counts);

  /// No image is to come: those that wait are counted.
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

/// Which of the two images of a pair.
enum class Half : std::uint8_t { a, b };

/// The images of A and B of a device that takes them in turn.
struct AlternatingPair {
  JoinedImages a;
  JoinedImages b;
};

/// Pairs the images of a device that takes A and B in turn: an A with the B after it.
///
/// Whether an image is A's or B's follows from how many periods have passed since the last one, and
/// is checked by content: none at the frequency of the shorter wavelength reaches beyond it. At the
/// beginning, and where times do not tell how many have passed, only content decides; until it
/// does, images are dropped.
class AlternatingPairer {
 public:
  struct Settings {
    double period_s = 0;        ///< between two images
    Half longer = Half::a;      ///< which of both has the longer wavelength
    std::optional<Half> first;  ///< what the first image is; else content tells
  };

  explicit AlternatingPairer(const Settings& settings);

  /// Takes the images of the next instant. `reaches_beyond`: whether ranges in it are longer than
  /// the shorter wavelength.
  std::optional<AlternatingPair> add(JoinedImages images, bool reaches_beyond,
                                     PairingCounts& counts);

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
