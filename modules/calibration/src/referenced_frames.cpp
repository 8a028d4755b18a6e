// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <memory>
#include <optional>
#include <utility>

#include <tofmap/calibration/fixed_pattern_fit.hpp>

namespace tofmap {
namespace {

/// Reads frames with their references, and keeps the last one, which is often wanted again.
class ReferenceReader {
 public:
  ReferenceReader(const SequenceReader& recording, const ReferenceRanges& reference,
                  const CameraCalibration& calibration)
      : recording_(recording), reference_(reference), calibration_(calibration) {}

  /// The frame without the change of its ranges. Null if it is damaged, has no reference or does
  /// not exist. Valid until the next call.
  const ReferencedFrame* read(int index) {
    if (index != index_) last_ = load(index);
    index_ = index;
    return last_.get();
  }

 private:
  std::unique_ptr<const ReferencedFrame> load(int index) const {
    if (index >= *recording_.frame_count()) return nullptr;
    SourcedFrame sourced = recording_.read(index);
    if (!sourced.frame) return nullptr;
    calibrate(*sourced.frame, recording_.sensor().modulation, calibration_);
    std::optional<ImageF> reference_m = reference_(*sourced.frame);
    if (!reference_m) return nullptr;
    return std::make_unique<const ReferencedFrame>(
        ReferencedFrame{std::move(*sourced.frame), std::move(*reference_m), {}});
  }

  const SequenceReader& recording_;
  const ReferenceRanges& reference_;
  const CameraCalibration& calibration_;
  std::unique_ptr<const ReferencedFrame> last_;
  int index_ = -1;
};

}  // namespace

ReferencedFrames referenced_frames(const SequenceReader& recording, std::vector<int> indices,
                                   ReferenceRanges reference, CameraCalibration calibration,
                                   std::function<bool()> keep_going) {
  return [&recording, indices = std::move(indices), reference = std::move(reference),
          calibration = std::move(calibration),
          keep_going = std::move(keep_going)](const auto& visit) {
    ReferenceReader reader(recording, reference, calibration);
    for (const int index : indices) {
      if (keep_going && !keep_going()) return;
      const ReferencedFrame* const found = reader.read(index);
      if (found == nullptr) continue;
      ReferencedFrame one = *found;
      if (const ReferencedFrame* const next = reader.read(index + 1)) {
        one.change_m = next->reference_m - one.reference_m;
      }
      visit(one);
    }
  };
}

}  // namespace tofmap
