// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/calibration/recording_samples.hpp"

#include <tofmap/core/image.hpp>

namespace tofmap {
namespace {

constexpr long most_samples = 2'000'000;
constexpr std::size_t most_first_frames = 12;

/// Every n-th pixel is used, so that about `most_samples` remain.
int pixel_stride(const SequenceReader& recording, int every_frame) {
  const CameraModel& camera = recording.sensor().camera;
  const long used_frames = 1 + (*recording.frame_count() - 1) / every_frame;
  const long pixels = 1L * camera.width_px * camera.height_px * used_frames;
  return static_cast<int>(1 + (pixels - 1) / most_samples);
}

}  // namespace

RecordingSamples collect_samples(const SequenceReader& recording, const ReferenceRanges& reference,
                                 int every_frame, const std::function<bool(int)>& keep_going) {
  const int stride = pixel_stride(recording, every_frame);
  RecordingSamples collected;
  ImageF last_phase;
  for (int i = 0; i < *recording.frame_count(); i += every_frame) {
    if (keep_going && !keep_going(i)) break;
    const SourcedFrame sourced = recording.read(i);
    ++collected.read;
    if (!sourced.frame) {
      if (collected.first_damage.empty()) collected.first_damage = sourced.damage;
      ++collected.damaged;
      continue;
    }
    const bool is_repeated = same_values(sourced.frame->phase_a, last_phase);
    last_phase = sourced.frame->phase_a;
    if (is_repeated) {
      ++collected.repeated;
      continue;
    }
    const std::optional<ImageF> reference_m = reference(*sourced.frame);
    if (!reference_m) continue;
    // The first pixel differs from frame to frame, so that all pixels of the camera are used.
    append_range_samples(*sourced.frame, recording.sensor(), *reference_m, i % stride, stride,
                         collected.samples);
    ++collected.frames;
    if (collected.first.size() < most_first_frames) collected.first.push_back(*sourced.frame);
  }
  return collected;
}

}  // namespace tofmap
