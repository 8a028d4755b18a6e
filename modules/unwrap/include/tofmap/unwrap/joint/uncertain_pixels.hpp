// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {

/// A factor of the probability of one wrap count.
struct CountWeight {
  int count = 0;
  float factor = 1;
};

/// Appends weights of the wrap counts of the pixel at this place of the frame, row by row.
using AppendWeights = std::function<void(int at, std::vector<CountWeight>& weights)>;

/// The pixels whose wrap counts are not certain, in the order of rows: what their phases and their
/// certain neighbours tell, and the edges between them.
///
/// Each pixel has `slots` places for numbers of its wrap counts. Wrap count n has the slot
/// n mod `slots`, so equal and successive wrap counts of neighbours have equal and successive
/// slots. If there are more wrap counts than slots, the likeliest one of those that share a slot
/// takes it, by the pixel's phases and its neighbours, and the others are left out.
class UncertainPixels {
 public:
  static constexpr std::size_t slots = 16;

  enum Direction { left, above, right, below };

  /// Values of neighbours() that are not the index of an uncertain pixel.
  static constexpr int is_certain = -1;
  static constexpr int no_return = -2;

  /// Finds the uncertain pixels of a frame, which replace the previous ones. `own` and `mixed` are
  /// those of the same frame; the other arguments are as in WrapCountModel::assign.
  /// `append_weights` tells more about wrap counts; it may be empty.
  void assign(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
              const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
              const OwnCounts& own, const ImageU8& mixed, const AppendWeights& append_weights);

  std::size_t size() const { return raster_.size(); }

  /// The places of the pixels in the frame, row by row.
  const std::vector<int>& raster() const { return raster_; }

  /// Whether wrap counts share slots.
  bool share_slots() const { return counts_ > static_cast<int>(slots); }

  /// The number of slots that are in use.
  std::size_t used_slots() const;

  /// Unary factors, times the messages of certain neighbours and other weights, of the slots of
  /// each pixel. The largest one of each pixel is 1; 0 in slots that are not in use.
  const std::vector<float>& evidence() const { return evidence_; }

  /// The wrap counts in the slots of each pixel. Empty unless wrap counts share slots; otherwise,
  /// slot n has wrap count n.
  const std::vector<float>& counts() const { return slot_counts_; }

  /// The neighbour of each pixel.
  const std::vector<int>& neighbours(Direction direction) const { return neighbour_[direction]; }

  /// Pairwise factors of the edges of each pixel, as in WrapCountModel::Edges, in the direction
  /// from the pixel on the left or above to the other one.
  const std::vector<float>& same(Direction direction) const { return same_[direction]; }
  const std::vector<float>& next(Direction direction) const { return next_[direction]; }

 private:
  void list(const Frame& frame, const OwnCounts& own);
  void connect(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
               const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior);
  void append_messages(std::size_t pixel, bool of_certain, const OwnCounts& own, int cols,
                       std::vector<CountWeight>& weights) const;

  int counts_ = 0;
  std::vector<int> raster_;
  std::vector<int> place_;  ///< of each pixel of the frame in raster_, or is_certain, or no_return
  PixelArrays pixels_;      ///< first frequency of the uncertain pixels
  PixelArrays others_;      ///< first frequency of their neighbours in one direction
  std::vector<float> evidence_;
  std::vector<float> slot_counts_;
  std::array<std::vector<int>, 4> neighbour_;
  std::array<std::vector<float>, 4> same_;
  std::array<std::vector<float>, 4> next_;
};

}  // namespace tofmap
