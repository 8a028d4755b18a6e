// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Saving and loading the state of a MapRun and of a FrameSample.

#include "tofmap/pipeline/frame_sample.hpp"
#include "tofmap/pipeline/pipeline.hpp"

#include <algorithm>
#include <optional>
#include <type_traits>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array_wrapper.hpp>
#include <boost/serialization/binary_object.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/tracking_state.hpp>

namespace boost::serialization {

template <class Archive, class Value>
void serialize(Archive& archive, tofmap::Image<Value>& image, unsigned) {
  Eigen::Index rows = image.rows();
  Eigen::Index cols = image.cols();
  archive& rows& cols;
  if constexpr (Archive::is_loading::value) image.resize(rows, cols);
  archive& make_array(image.data(), static_cast<std::size_t>(image.size()));
}

template <class Archive>
void serialize(Archive& archive, tofmap::FilterCount& count, unsigned) {
  archive& count.filter& count.reason& count.removed& count.corrected;
}

template <class Archive>
void serialize(Archive& archive, tofmap::StageTimes& times, unsigned) {
  archive& times.unwrap_ms& times.filter_ms& times.cloud_ms;
  archive& times.register_ms& times.map_ms& times.loop_ms;
}

template <class Archive>
void serialize(Archive& archive, tofmap::FrameRecord& record, unsigned) {
  archive& record.index& record.timestamp_s& record.damage& record.repeats& record.iterations;
  archive& record.curl_violations& record.phase_noise_cycles& record.valid_pixels;
  archive& record.kept_pixels& record.filters& record.times;  // save() stores `tracking`
}

template <class Archive>
void serialize(Archive& archive, tofmap::Frame& frame, unsigned) {
  archive& frame.index& frame.timestamp_s& frame.phases& frame.amplitudes;
}

template <class Archive>
void serialize(Archive& archive, tofmap::RangeImage& image, unsigned) {
  archive& image.range_m& image.sigma_m& image.wrap_count& image.confidence& image.reason;
  archive& image.averaged_px& image.systematic_m;
}

template <class Archive>
void serialize(Archive& archive, tofmap::SampledFrame& frame, unsigned) {
  tofmap::UnwrapResult& unwrapped = frame.unwrapped;
  archive& frame.recorded& frame.returns& frame.filtered& unwrapped.image& unwrapped.iterations;
  archive& unwrapped.curl_violations& unwrapped.phase_noise_cycles& unwrapped.regions;
  bool is_known = unwrapped.converged.has_value();
  bool is_converged = unwrapped.converged.value_or(false);
  archive& is_known& is_converged;
  if constexpr (Archive::is_loading::value) {
    unwrapped.converged = is_known ? std::optional(is_converged) : std::nullopt;
  }
}

}  // namespace boost::serialization

namespace tofmap {

template <class Archive>
void ErrorTally::serialize(Archive& archive, unsigned) {
  static_assert(std::is_trivially_copyable_v<CameraErrors>);
  std::size_t count = cameras_.size();
  archive& count;
  if constexpr (Archive::is_loading::value) {
    if (count > most_frequencies) throw InputError("too many frequencies");
    cameras_.resize(count);
  }
  for (CameraErrors& camera : cameras_) {
    archive& boost::serialization::make_binary_object(&camera, sizeof camera);
  }
  archive& frames_& flows_px_& pixels_& ambient_pixels_& ambient_factors_& has_amplitudes_;
}

void FrameSample::save(std::ostream& out) const {
  boost::archive::binary_oarchive archive(out);
  archive << frames_;
}

void FrameSample::load(std::istream& in, int frames_done) {
  boost::archive::binary_iarchive archive(in);
  archive >> frames_;
  const auto wanted = static_cast<int>(std::ranges::lower_bound(wanted_indices_, frames_done) -
                                       wanted_indices_.begin());
  thin_out(wanted);
}

void MapRun::save(std::ostream& out) const {
  {
    boost::archive::binary_oarchive archive(out);
    archive << frames_ << last_.phases << errors_;
  }
  std::vector<TrackingResult> tracking;
  for (const FrameRecord& frame : frames_) tracking.push_back(frame.tracking);
  save_tracking(tracking, out);
  measurer_.save(out);
  mapper_.save(out);
}

void MapRun::load(std::istream& in) {
  {
    boost::archive::binary_iarchive archive(in);
    archive >> frames_ >> last_.phases >> errors_;
  }
  std::vector<TrackingResult> tracking = load_tracking(in);
  if (tracking.size() != frames_.size()) throw InputError("map state: frames and tracking differ");
  for (std::size_t i = 0; i < tracking.size(); ++i) frames_[i].tracking = std::move(tracking[i]);
  ahead_.clear();
  measurer_.load(in);
  mapper_.load(in);
}

}  // namespace tofmap
