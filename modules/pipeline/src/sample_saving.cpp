// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Saving and loading a FrameSample.

#include "tofmap/pipeline/frame_sample.hpp"

#include <algorithm>
#include <exception>
#include <functional>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <tofmap/core/bytes.hpp>
#include <tofmap/mapping/map_store.hpp>

namespace tofmap {
namespace {

constexpr const char* sample_entries = "run/sample/";
constexpr int any = std::numeric_limits<int>::max();

void write(const std::vector<ImageF>& images, ByteWriter& out) {
  out.number(static_cast<std::uint32_t>(images.size()));
  for (const ImageF& image : images) out.image(image);
}

void write(const Frame& frame, ByteWriter& out) {
  out.number(frame.index);
  out.number(frame.timestamp_s);
  write(frame.phases, out);
  write(frame.amplitudes, out);
}

void write(const RangeImage& image, ByteWriter& out) {
  out.image(image.range_m);
  out.image(image.sigma_m);
  out.image(image.wrap_count);
  out.image(image.confidence);
  out.image(image.reason);
  out.image(image.averaged_px);
  out.number(image.systematic_m);
}

/// Reads frames and images of one size.
class SampleReader {
 public:
  SampleReader(const std::string& bytes, const CameraModel& camera)
      : in_(bytes), rows_(camera.height_px), cols_(camera.width_px) {}

  std::vector<ImageF> images() {
    std::vector<ImageF> images(in_.number<std::uint32_t>(0, most_frequencies));
    for (ImageF& image : images) image = in_.image<float>(rows_, cols_);
    return images;
  }

  Frame frame() {
    Frame frame;
    frame.index = in_.number<int>(0, any);
    frame.timestamp_s = in_.number<double>();
    frame.phases = images();
    frame.amplitudes = images();
    return frame;
  }

  RangeImage ranges() {
    RangeImage image;
    image.range_m = in_.image<float>(rows_, cols_);
    image.sigma_m = in_.image<float>(rows_, cols_);
    image.wrap_count = in_.image<std::uint8_t>(rows_, cols_);
    image.confidence = in_.image<float>(rows_, cols_);
    image.reason = in_.image<std::uint8_t>(rows_, cols_);
    image.averaged_px = in_.image<float>(rows_, cols_);
    image.systematic_m = in_.number<double>();
    const bool is_whole = same_size(image.range_m, image.sigma_m) &&
                          same_size(image.range_m, image.wrap_count) &&
                          same_size(image.range_m, image.confidence) &&
                          same_size(image.range_m, image.reason) && image.range_m.size() > 0;
    constexpr auto last_reason = static_cast<std::uint8_t>(InvalidReason::free_space_violation);
    if (!is_whole || image.reason.maxCoeff() > last_reason) {
      throw InputError("a range image is damaged");
    }
    return image;
  }

  SampledFrame sampled() {
    SampledFrame frame;
    frame.recorded = this->frame();
    frame.returns = this->frame();
    frame.unwrapped.image = ranges();
    frame.unwrapped.iterations = in_.number<int>(0, any);
    frame.unwrapped.curl_violations = in_.number<int>(0, any);
    frame.unwrapped.phase_noise_cycles = in_.number<double>();
    frame.unwrapped.regions = in_.number<int>(0, any);
    constexpr std::uint8_t unknown = 2;
    const auto converged = in_.number<std::uint8_t>(0, unknown);
    if (converged != unknown) frame.unwrapped.converged = converged == 1;
    frame.filtered = ranges();
    in_.expect_end();
    if (frame.recorded.phases.empty() ||
        frame.recorded.phases.size() != frame.returns.phases.size()) {
      throw InputError("a frame is damaged");
    }
    return frame;
  }

 private:
  ByteReader in_;
  Eigen::Index rows_;
  Eigen::Index cols_;
};

std::string bytes_of(const SampledFrame& frame) {
  ByteWriter out;
  write(frame.recorded, out);
  write(frame.returns, out);
  write(frame.unwrapped.image, out);
  out.number(frame.unwrapped.iterations);
  out.number(frame.unwrapped.curl_violations);
  out.number(frame.unwrapped.phase_noise_cycles);
  out.number(frame.unwrapped.regions);
  const auto converged = frame.unwrapped.converged;
  out.number<std::uint8_t>(converged ? (*converged ? 1 : 0) : 2);
  write(frame.filtered, out);
  return out.take();
}

std::string entry_of(const SampledFrame& frame) {
  return fmt::format("{}{:09}", sample_entries, frame.recorded.index);
}

bool is_in_memory(const SampledFrame& frame) { return !frame.recorded.phases.empty(); }

}  // namespace

void FrameSample::save(MapStore::Commit& commit) const {
  for (const SampledFrame& frame : frames_) {
    if (!unsaved_.contains(frame.recorded.index)) continue;
    commit.put(entry_of(frame), bytes_of(frame));
  }
}

void FrameSample::note_saved(const MapStore& store) {
  unsaved_.clear();
  read_entry_ = store.reader();
  for (SampledFrame& frame : frames_) {
    const int index = frame.recorded.index;
    frame = {};
    frame.recorded.index = index;
  }
}

/// Reads a frame into memory if it is in the file alone. Throws InputError if that fails.
void FrameSample::read(SampledFrame& frame) const {
  if (is_in_memory(frame)) return;
  const std::string name = entry_of(frame);
  const std::string bytes = read_entry_(name);
  frame = naming(name, [&] { return SampleReader(bytes, camera_).sampled(); });
}

void FrameSample::bring_back() {
  std::exception_ptr failure;
  for (SampledFrame& frame : frames_) {
    try {
      read(frame);
    } catch (const InputError&) {
      if (!failure) failure = std::current_exception();
    }
  }
  std::erase_if(frames_, std::not_fn(is_in_memory));
  if (failure) std::rethrow_exception(failure);
}

const std::vector<SampledFrame>& FrameSample::frames() const {
  if (!std::ranges::all_of(frames_, is_in_memory)) {
    throw UsageError("frames of the sample are in the file alone");
  }
  return frames_;
}

void FrameSample::load(const MapStore& store, int frames_done) {
  frames_.clear();
  unsaved_.clear();
  for (const std::string& name : store.entries(sample_entries)) {
    const std::string bytes = store.expected_entry(name);
    frames_.push_back(naming(name, [&] { return SampleReader(bytes, camera_).sampled(); }));
  }
  const auto wanted = static_cast<int>(std::ranges::lower_bound(wanted_indices_, frames_done) -
                                       wanted_indices_.begin());
  thin_out(wanted);
}

}  // namespace tofmap
