// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/recording.hpp"
#include "views/viewed.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/visualization/cloud_pictures.hpp>

namespace tofmap::app {
namespace {

constexpr int legend_height_px = 220;

class ViewedRecording final : public Viewed {
 public:
  ViewedRecording(const ViewRequest& request, const ProgramOptions& options)
      : Viewed(color_names::frame),
        source_(open_recording(request.path, options.camera)),
        rays_(pixel_rays(source_.sensor().camera)),
        unwrapper_(source_.sensor(), options.pipeline.unwrap),
        filters_(options.pipeline.filters),
        is_wrapped_(request.wrapped) {
    const int frame = request.frame.value_or(0);
    if (frame >= *source_.frame_count()) {
      throw UsageError("--frame " + std::to_string(frame) + ": the recording has " +
                       counted(static_cast<std::size_t>(*source_.frame_count()), "frame"));
    }
    read(frame);
    if (!damage_.empty()) throw InputError(damage_);
  }

  Drawing drawing() const override {
    const ColorScale scale = this->scale();
    return frame_drawing(ranges_m(), rays_, [&](Eigen::Index row, Eigen::Index col) {
      const int count = image().wrap_count(row, col);
      if (color() == "moved") return count > 0 ? colors::corrected : unmoved;
      if (color() == "wrap") return wrap_count_color(count);
      return scale(value(row, col));
    });
  }

  Viewpoint viewpoint(const std::string& from, double /*aspect*/) const override {
    const ImageF& range_m = image().range_m;
    return from == "above" ? frame_viewpoint_above(range_m, rays_)
                           : frame_viewpoint_left(range_m, rays_);
  }

  Picture legend() const override {
    if (color() == "moved") {
      return color_key({{unmoved, "within one wavelength"}, {colors::corrected, "moved"}});
    }
    if (color() != "wrap") return color_bar(scale(), legend_height_px);
    std::vector<LegendEntry> counts;
    const ImageU8& count = image().wrap_count;
    for (int i = 0; i < invalid_wrap_count; ++i) {
      if ((count == static_cast<std::uint8_t>(i)).any()) {
        counts.push_back({wrap_count_color(i), std::to_string(i) + " wraps"});
      }
    }
    return counts.empty() ? Picture() : color_key(counts);
  }

  std::string status() const override {
    std::string text =
        fmt::format("frame {} of {}, {:.2f} s: ", index_, *source_.frame_count(), time_s_);
    if (!damage_.empty()) return text + damage_;
    text += is_wrapped_ ? "ranges as measured" : "unwrapped";
    text += is_filtered_ ? ", filtered" : ", not filtered";
    return text + ", " + counted(static_cast<std::size_t>(image().count_valid()), "point") +
           ", coloured by " + color();
  }

  std::string help() const override {
    return "left, right: previous or next frame (up, down: ten), u: as measured or unwrapped, x: "
           "with or without filters";
  }

  bool take_key(const std::string& key) override {
    if (key == "Right") return step(1);
    if (key == "Left") return step(-1);
    if (key == "Up") return step(10);
    if (key == "Down") return step(-10);
    if (key != "u" && key != "x") return false;
    bool& choice = key == "u" ? is_wrapped_ : is_filtered_;
    choice = !choice;
    return true;
  }

 private:
  static constexpr Rgb unmoved{60, 90, 130};

  bool step(int frames) {
    const int wanted = std::clamp(index_ + frames, 0, *source_.frame_count() - 1);
    if (wanted == index_) return false;
    read(wanted);
    return true;
  }

  /// Reads, unwraps and filters a frame. A damaged frame is shown as empty, and the status says
  /// why.
  void read(int index) {
    const CameraModel& camera = source_.sensor().camera;
    const SourcedFrame sourced = source_.read(index);
    index_ = index;
    time_s_ = sourced.timestamp_s;
    damage_ = sourced.damage;
    unwrapped_ = filtered_ = RangeImage(camera.height_px, camera.width_px);
    wrapped_m_ = unwrapped_.range_m;
    amplitude_ = ImageF();
    if (!sourced.frame) return;
    const Modulation& modulation = source_.sensor().modulation;
    unwrapped_ = unwrapper_.unwrap(*sourced.frame).image;
    filtered_ = apply_filters(unwrapped_, *sourced.frame, modulation, rays_, filters_).image;
    wrapped_m_ = sourced.frame->phases[0] * static_cast<float>(modulation.wavelength_m(0));
    amplitude_ = sourced.frame->has_amplitude() ? sourced.frame->amplitudes.front() : ImageF();
  }

  const RangeImage& image() const { return is_filtered_ ? filtered_ : unwrapped_; }

  ImageF ranges_m() const {
    return is_wrapped_ ? ImageF((image().reason == 0).select(wrapped_m_, NAN)) : image().range_m;
  }

  double value(Eigen::Index row, Eigen::Index col) const {
    const float range_m = is_wrapped_ ? wrapped_m_(row, col) : image().range_m(row, col);
    if (color() == "confidence") return image().confidence(row, col);
    if (color() == "height") return -range_m * rays_.y(row, col);
    if (color() == "amplitude") {
      return amplitude_.size() > 0 ? std::sqrt(amplitude_(row, col)) : NAN;
    }
    return range_m;
  }

  /// The colour scale of the frame, between the 1st and 99th percentiles of the values. Scales of
  /// ranges and amplitudes begin at 0.
  ColorScale scale() const {
    if (color() == "confidence") return {0, 1, "confidence"};
    std::vector<double> values;
    const ImageF shown_m = ranges_m();
    for (Eigen::Index row = 0; row < shown_m.rows(); ++row) {
      for (Eigen::Index col = 0; col < shown_m.cols(); ++col) {
        const double found = value(row, col);
        if (std::isfinite(shown_m(row, col)) && std::isfinite(found)) values.push_back(found);
      }
    }
    std::ranges::sort(values);
    const double low = values.empty() ? 0 : values[values.size() / 100];
    const double high = values.empty() ? 1 : values[values.size() * 99 / 100];
    if (color() == "height") return {low, std::max(low + 0.1, high), "height above the camera, m"};
    if (color() == "amplitude") return {0, std::max(1.0, high), "square root of amplitude"};
    return {0, std::max(1.0, std::ceil(high)), "range, m"};
  }

  SequenceReader source_;
  PixelRays rays_;
  Unwrapper unwrapper_;
  FilterOptions filters_;
  bool is_wrapped_;
  bool is_filtered_ = true;
  int index_ = 0;
  double time_s_ = 0;
  std::string damage_;
  RangeImage unwrapped_;
  RangeImage filtered_;
  ImageF wrapped_m_;
  ImageF amplitude_;
};

}  // namespace

std::unique_ptr<Viewed> view_recording(const ViewRequest& request, const ProgramOptions& options) {
  return std::make_unique<ViewedRecording>(request, options);
}

}  // namespace tofmap::app
