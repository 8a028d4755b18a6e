// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/calibration/recording_samples.hpp"

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr long most_samples = 2'000'000;
constexpr std::size_t most_first_frames = 12;

/// Stride between used pixels, so that at most about `most_samples` are taken.
int pixel_stride(const SequenceReader& recording, int every_frame) {
  const CameraModel& camera = recording.sensor().camera;
  const long used_frames = 1 + (*recording.frame_count() - 1) / every_frame;
  const long pixels = 1L * camera.width_px * camera.height_px * used_frames;
  return static_cast<int>(1 + (pixels - 1) / most_samples);
}

}  // namespace

RecordingSamples collect_samples(const SequenceReader& recording, const ReferenceRanges& reference,
                                 int every_frame, const std::function<bool(int)>& keep_going) {
  if (every_frame < 1) {
    throw UsageError("collect_samples: every_frame is " + std::to_string(every_frame) +
                     "; it must be at least 1");
  }
  const int stride = pixel_stride(recording, every_frame);
  RecordingSamples collected;
  const std::size_t frequencies = recording.sensor().modulation.count();
  for (std::size_t b = 1; b < frequencies; ++b) collected.others.push_back(b);
  if (collected.others.empty()) collected.others.push_back(0);
  collected.samples.resize(collected.others.size());
  Frame last;
  for (int i = 0; i < *recording.frame_count(); i += every_frame) {
    if (keep_going && !keep_going(i)) break;
    const SourcedFrame sourced = recording.read(i);
    ++collected.read;
    if (!sourced.frame) {
      if (collected.first_damage.empty()) collected.first_damage = sourced.damage;
      ++collected.damaged;
      continue;
    }
    const bool is_repeated = repeats(*sourced.frame, last);
    last = *sourced.frame;
    if (is_repeated) {
      ++collected.repeated;
      continue;
    }
    const std::optional<ImageF> reference_m = reference(*sourced.frame);
    if (!reference_m) continue;
    // The first pixel differs from frame to frame, so that all pixels of the camera are used.
    for (std::size_t b = 0; b < collected.others.size(); ++b) {
      append_range_samples(*sourced.frame, recording.sensor(), *reference_m, collected.others[b],
                           (collected.read - 1) % stride, stride, collected.samples[b]);
    }
    ++collected.frames;
    collected.frame_indices.push_back(i);
    if (collected.first_frames.size() < most_first_frames)
      collected.first_frames.push_back(*sourced.frame);
  }
  return collected;
}

}  // namespace tofmap
