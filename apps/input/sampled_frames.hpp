// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::app {

/// Indices in the middles of `wanted` equal parts of a recording.
std::vector<int> spread_indices(int total, int wanted);

/// At most `wanted` of the first `total` frames of a recording, spread evenly over these. Damaged
/// ones are left out, and none comes in their place.
std::vector<DualFrequencyFrame> sampled_frames(const SequenceReader& recording, int total,
                                               int wanted);

/// Passes the frames of another source on, and keeps some, spread evenly over all that came: of a
/// device, which does not come again.
class SamplingSource final : public FrameSource {
 public:
  /// Keeps at least `wanted` frames if as many come, and less than twice as many; fewer where they
  /// would need more than 128 MB, but at least one.
  SamplingSource(FrameSource& source, int wanted);

  const SensorModel& sensor() const override { return source_.sensor(); }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return source_.frame_count(); }

  const std::vector<DualFrequencyFrame>& kept() const { return kept_; }

 private:
  FrameSource& source_;
  std::size_t most_;
  std::size_t step_ = 1;  ///< every so many frames are kept
  std::size_t passed_ = 0;
  std::vector<DualFrequencyFrame> kept_;
};

}  // namespace tofmap::app
