// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::app {

/// Passes the frames of another source on, and looks at them: at the first whether A and B belong
/// together, and are ranges along rays, and at all for gaps in time (docs/cameras.md).
class WatchedSource final : public FrameSource {
 public:
  explicit WatchedSource(FrameSource& source) : source_(source) {}

  const SensorModel& sensor() const override { return source_.sensor(); }
  std::optional<SourcedFrame> next() override;
  std::optional<int> frame_count() const override { return source_.frame_count(); }

  /// What the frames so far are doubted for.
  std::vector<std::string> doubts();

 private:
  void judge();

  FrameSource& source_;
  std::vector<DualFrequencyFrame> first_;
  std::optional<std::vector<std::string>> doubts_;  ///< of the first; none before they have come
  std::vector<double> times_s_;
};

/// What a recording is doubted for in the same way.
std::vector<std::string> doubts_about(const SequenceReader& recording);

}  // namespace tofmap::app
