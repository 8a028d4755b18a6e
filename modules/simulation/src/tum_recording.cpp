// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/tum_recording.hpp"

#include "pixel_signal.hpp"
#include "sensor_effects.hpp"
#include "simulator_options.hpp"
#include "systematic_errors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

/// Truth images hold millimetres in 16 bits.
constexpr float longest_range_m = 65.5F;

/// A line of depth.txt.
struct Line {
  double timestamp_s = 0;
  std::string file;
};

/// Parses a line into `line`. Returns what is wrong with it, or an empty string. Lines must be
/// later than `last_time_s`.
std::string complaint_about(const std::string& text, double last_time_s, Line& line) {
  std::istringstream words(text);
  if (!(words >> line.timestamp_s >> line.file)) return "'" + text + "' is not 'timestamp file'";
  // Timestamps are written in microseconds: closer times would be the same instant.
  constexpr double least_step_s = 1e-6;
  if (line.timestamp_s - last_time_s < least_step_s) {
    return "its timestamp is not later than that of the previous line";
  }
  return "";
}

struct ImageList {
  std::vector<Line> lines;
  std::vector<std::string> damages;  ///< what is wrong with the lines that cannot be used
};

/// Reads depth.txt. Throws InputError if it has no line that can be used.
ImageList read_list(const std::filesystem::path& file) {
  refuse_no_file(file);
  std::ifstream in(file);
  if (!in) {
    throw InputError(file.string() +
                     ": cannot be read; a recording of the TUM RGB-D benchmark has depth.txt with "
                     "lines 'timestamp file'");
  }
  ImageList list;
  double last_time_s = -std::numeric_limits<double>::infinity();
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos || text[first] == '#') continue;
    Line line;
    const std::string complaint = complaint_about(text, last_time_s, line);
    if (!complaint.empty()) {
      list.damages.push_back(file.string() + ":" + std::to_string(number) + ": " + complaint);
      continue;
    }
    last_time_s = line.timestamp_s;
    list.lines.push_back(std::move(line));
  }
  if (!list.lines.empty()) return list;
  throw InputError(list.damages.empty() ? file.string() + ": lists no image"
                                        : list.damages.front());
}

/// Every n-th pixel of an image in both axes, beginning with pixel n / 2.
ImageU16 thinned(const ImageU16& image, int n) {
  return image(Eigen::seq(n / 2, Eigen::last, n), Eigen::seq(n / 2, Eigen::last, n));
}

/// The camera of thinned images, of which `first` is one.
CameraModel thinned_camera(const TumOptions& options, const ImageU16& first) {
  const int n = options.every_pixel;
  CameraModel camera;
  camera.width_px = static_cast<int>(first.cols());
  camera.height_px = static_cast<int>(first.rows());
  camera.fx_px = options.fx_px / n;
  camera.fy_px = options.fy_px / n;
  const int first_px = n / 2;  // of the pixels that thinned() takes
  camera.cx_px = (options.cx_px - first_px) / n;
  camera.cy_px = (options.cy_px - first_px) / n;
  return camera;
}

/// Options of the simulator that need no scene.
constexpr std::string_view used_options[] = {"frequency_a_hz",      "frequency_b_hz",
                                             "frequencies_hz",      "contrasts",
                                             "range_noise_m",       "wiggle_m",
                                             "dark_level",          "full_well",
                                             "offset_a_m",          "offset_b_m",
                                             "periodic_a_m",        "periodic_b_m",
                                             "amplitude_error_a_m", "amplitude_error_b_m",
                                             "offsets_m",           "periodic_errors_m",
                                             "amplitude_errors_m",  "fixed_pattern_m",
                                             "errors_seed",         "ambient_noise",
                                             "ambient_left",        "ambient_top",
                                             "ambient_right",       "ambient_bottom",
                                             "phase_bits",          "frames",
                                             "max_range_m",         "seed"};

/// Throws UsageError if an option is set that would have no effect.
void refuse_unused(SimulatorOptions options) {
  SimulatorOptions defaults;
  OptionTable given;
  OptionTable unset;
  given.bind("simulator", options);
  unset.bind("simulator", defaults);
  const std::vector<OptionText> given_texts = given.texts();
  const std::vector<OptionText> unset_texts = unset.texts();
  for (std::size_t i = 0; i < given_texts.size(); ++i) {
    const OptionText& option = given_texts[i];
    const bool is_used = std::ranges::find(used_options, option.name) != std::end(used_options);
    if (is_used || option.value == unset_texts[i].value) continue;
    throw UsageError(option.key() +
                     " needs a scene and has no effect on recorded depth; leave it out");
  }
}

/// An image of the typical size: the first image whose size an earlier image has as well, so that a
/// single odd image does not determine the size. If all sizes differ, it is the first image. Throws
/// InputError if no image can be read.
ImageU16 typical_image(const std::vector<TumRecording::DepthImage>& images) {
  std::vector<ImageU16> seen;
  std::string damage;
  for (const TumRecording::DepthImage& image : images) {
    try {
      ImageU16 read = read_png_16(image.file);
      if (std::ranges::any_of(seen, [&](const ImageU16& one) { return same_size(one, read); })) {
        return read;
      }
      seen.push_back(std::move(read));
    } catch (const InputError& error) {
      if (damage.empty()) damage = error.what();
    }
  }
  if (seen.empty()) throw InputError(damage);
  return seen.front();
}

/// The signal of a surface at `range_m`, without noise and range errors.
std::complex<double> ideal_signal(double strength, double range_m, double wavelength_m,
                                  const SensorEffects& effects) {
  const PixelLight light = light_from(strength, range_m, wavelength_m);
  return effects.are_none() ? light.first : demodulate({light, light, light, light}, effects);
}

/// Takes the returns of pixels away that have none at one of the frequencies.
void drop_partial_returns(Frame& frame) {
  for (Eigen::Index i = 0; i < frame.phases.front().size(); ++i) {
    const auto is_missing = [i](const ImageF& phase) { return std::isnan(phase.data()[i]); };
    if (std::ranges::none_of(frame.phases, is_missing)) continue;
    for (ImageF& phase : frame.phases) phase.data()[i] = nan;
    for (ImageF& amplitude : frame.amplitudes) amplitude.data()[i] = 0;
  }
}

}  // namespace

std::vector<OptionField<TumOptions>> TumOptions::fields() {
  using T = TumOptions;
  return {
      {"fx_px", &T::fx_px, 1, 1e5, "px", "focal length of the depth images"},
      {"fy_px", &T::fy_px, 1, 1e5, "px", "focal length of the depth images"},
      {"cx_px", &T::cx_px, -1e5, 1e5, "px", "principal point of the depth images"},
      {"cy_px", &T::cy_px, -1e5, 1e5, "px", "principal point of the depth images"},
      {"steps_per_m", &T::steps_per_m, 1, 1e6, "",
       "value of the depth images for a depth of one metre"},
      {"every_pixel", &T::every_pixel, 1, 16, "", "uses every n-th pixel in both axes"},
      {"reflectance", &T::reflectance, 0.01, 1, "", "reflectance of all surfaces"},
      {"max_pose_gap_s", &T::max_pose_gap_s, 0, 10, "s",
       "largest time between an image and a pose that is used for it"},
  };
}

TumRecording::TumRecording(std::filesystem::path folder, const TumOptions& options,
                           const SimulatorOptions& simulator)
    : folder_(std::move(folder)), options_(options), simulator_(simulator) {
  refuse_unused(simulator_);
  check_systematic_errors(simulator_);
  ImageList list = read_list(folder_ / "depth.txt");
  for (const Line& line : list.lines) images_.push_back({line.timestamp_s, folder_ / line.file});
  left_out_ = std::move(list.damages);
  const std::filesystem::path poses = folder_ / "groundtruth.txt";
  std::error_code unknown;
  if (std::filesystem::exists(poses, unknown)) {
    UsableTrajectory usable = read_usable_trajectory(poses);
    poses_ = std::move(usable.poses);
    damaged_poses_ = std::move(usable.damages);
  }
  sensor_.camera = thinned_camera(options_, thinned(typical_image(images_), options_.every_pixel));
  sensor_.modulation = modulation_of(simulator);
  sensor_.max_range_m = simulator.max_range_m;
  validate(sensor_.camera);
  validate(sensor_.modulation);
  rays_ = pixel_rays(sensor_.camera);
}

TumRecording::FrameWithTruth TumRecording::read(int index) const {
  const DepthImage& image = images_.at(static_cast<std::size_t>(index));
  const ImageU16 depth = thinned(read_png_16(image.file), options_.every_pixel);
  if (!same_size(depth, rays_.z)) {
    throw InputError(image.file.string() + ": differs in size from the other images");
  }
  FrameWithTruth out;
  out.world_from_camera = pose_at(poses_, image.timestamp_s, options_.max_pose_gap_s);
  out.range_truth_m = ImageF::Constant(depth.rows(), depth.cols(), nan);
  const Modulation& modulation = sensor_.modulation;
  const SensorEffects effects = sensor_effects(simulator_, modulation);
  const std::complex<double> nothing(std::numeric_limits<double>::quiet_NaN(), 0);
  IdealFrame ideal;
  ideal.index = index;
  ideal.timestamp_s = image.timestamp_s;
  ideal.signals.assign(modulation.count(), ImageC::Constant(depth.rows(), depth.cols(), nothing));
  const float farthest_m = sensor_.max_range_m > 0
                               ? std::min(longest_range_m, static_cast<float>(sensor_.max_range_m))
                               : longest_range_m;
  for (Eigen::Index i = 0; i < depth.size(); ++i) {
    if (depth.data()[i] == 0) continue;
    const float range_m =
        static_cast<float>(depth.data()[i] / options_.steps_per_m) / rays_.z.data()[i];
    if (range_m > farthest_m) continue;
    out.range_truth_m.data()[i] = range_m;
    const double strength = amplitude_unit * options_.reflectance / (double{range_m} * range_m);
    for (std::size_t f = 0; f < modulation.count(); ++f) {
      ideal.signals[f].data()[i] =
          ideal_signal(strength, double{range_m}, modulation.wavelength_m(f), effects);
    }
  }
  out.frame = measured_frame(ideal, sensor_, simulator_);
  drop_partial_returns(out.frame);
  return out;
}

}  // namespace tofmap
