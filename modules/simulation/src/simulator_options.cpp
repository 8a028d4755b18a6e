// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulator_options.hpp"

#include "systematic_errors.hpp"

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// Throws UsageError if a list of errors does not have a value for each frequency.
void check_lists(const SimulatorOptions& options) {
  const std::size_t frequencies = modulation_of(options).count();
  const auto check = [&](const char* name, const std::vector<double>& list) {
    if (list.empty() || list.size() == frequencies) return;
    throw UsageError(std::string("simulator.") + name + " has " + counted(list.size(), "value") +
                     ", but there " + (frequencies == 1 ? "is " : "are ") +
                     counted(frequencies, "frequency", "frequencies"));
  };
  check("offsets_m", options.offsets_m);
  check("periodic_errors_m", options.periodic_errors_m);
  check("amplitude_errors_m", options.amplitude_errors_m);
}

}  // namespace

std::span<const NamedValue<PeoplePaths>> named_values(PeoplePaths) {
  static constexpr NamedValue<PeoplePaths> values[] = {
      {"ahead", PeoplePaths::ahead}, {"own", PeoplePaths::own}, {"both", PeoplePaths::both}};
  return values;
}

std::vector<OptionField<SimulatorOptions>> SimulatorOptions::fields() {
  using S = SimulatorOptions;
  return {
      {"width_px", &S::width_px, 8, 4096, "px", "image width"},
      {"height_px", &S::height_px, 8, 4096, "px", "image height"},
      {"horizontal_fov_deg", &S::horizontal_fov_deg, 1, 150, "deg", "horizontal field of view"},
      {"distortion_k1", &S::distortion_k1, -10, 10, "", "radial distortion, as OpenCV's k1"},
      {"distortion_k2", &S::distortion_k2, -10, 10, "", "radial distortion, as OpenCV's k2"},
      {"distortion_p1", &S::distortion_p1, -1, 1, "", "tangential distortion, as OpenCV's p1"},
      {"distortion_p2", &S::distortion_p2, -1, 1, "", "tangential distortion, as OpenCV's p2"},
      {"distortion_k3", &S::distortion_k3, -10, 10, "", "radial distortion, as OpenCV's k3"},
      {"frequency_a_hz", &S::frequency_a_hz, 1e6, 1e9, "Hz", "modulation frequency of image A"},
      {"frequency_b_hz", &S::frequency_b_hz, 1e6, 1e9, "Hz", "modulation frequency of image B"},
      {"frequencies_hz", &S::frequencies_hz, 1e6, 1e9, "Hz",
       "one to eight modulation frequencies in place of those of A and B; none: A and B"},
      {"contrasts", &S::contrasts, 0.01, 1, "",
       "factor of the signal at each frequency; 1 at those that the list does not have"},
      {"range_noise_m", &S::range_noise_m, 0, 10, "m",
       "standard deviation of A's range at 5 m on a surface of reflectance 0.5 facing the camera"},
      {"subpixels", &S::subpixels, 1, 16, "", "rays per pixel along each of its sides"},
      {"wiggle_m", &S::wiggle_m, 0, 0.2, "m",
       "amplitude of the wiggling of A's ranges, four periods per wavelength; B has the same phase "
       "error"},
      {"multipath_rays", &S::multipath_rays, 0, 4096, "",
       "rays per pixel for light that arrives by way of one other surface; 0: no such light"},
      {"dark_level", &S::dark_level, 0, 65535, "",
       "charge of a sample without light, in units of the amplitude; it adds shot noise"},
      {"full_well", &S::full_well, 0, 1e6, "",
       "largest charge that a sample can hold, in units of the amplitude; 0: no limit"},
      {"exposure_share", &S::exposure_share, 0, 1, "",
       "duration of the four samples of an image, as a fraction of the frame period"},
      {"offset_a_m", &S::offset_a_m, -0.2, 0.2, "m",
       "constant error of A's ranges, measured minus true"},
      {"offset_b_m", &S::offset_b_m, -0.2, 0.2, "m",
       "constant error of B's ranges, measured minus true"},
      {"periodic_a_m", &S::periodic_a_m, 0, 0.2, "m",
       "largest periodic error of A's ranges, with two and four periods per wavelength"},
      {"periodic_b_m", &S::periodic_b_m, 0, 0.2, "m",
       "largest periodic error of B's ranges, with two and four periods per wavelength"},
      {"amplitude_error_a_m", &S::amplitude_error_a_m, -0.2, 0.2, "m",
       "error of A's ranges at an amplitude of 60; it falls with the logarithm of the amplitude, "
       "to 0 at 60000"},
      {"amplitude_error_b_m", &S::amplitude_error_b_m, -0.2, 0.2, "m",
       "error of B's ranges at an amplitude of 60; it falls with the logarithm of the amplitude, "
       "to 0 at 60000"},
      {"offsets_m", &S::offsets_m, -0.2, 0.2, "m",
       "constant errors of all frequencies, in place of offset_a_m and offset_b_m"},
      {"periodic_errors_m", &S::periodic_errors_m, 0, 0.2, "m",
       "largest periodic errors of all frequencies, in place of periodic_a_m and periodic_b_m"},
      {"amplitude_errors_m", &S::amplitude_errors_m, -0.2, 0.2, "m",
       "errors with amplitude of all frequencies, in place of amplitude_error_a_m and "
       "amplitude_error_b_m"},
      {"fixed_pattern_m", &S::fixed_pattern_m, 0, 0.2, "m",
       "standard deviation of the constant range errors of individual pixels at each frequency"},
      {"errors_seed", &S::errors_seed, 0, 2147483647, "",
       "seed of the periodic errors and of the fixed pattern: it identifies the camera"},
      {"ambient_noise", &S::ambient_noise, 1, 20, "",
       "factor by which ambient light increases the noise where it falls; 1: no ambient light"},
      {"ambient_left", &S::ambient_left, 0, 1, "",
       "left edge of the rectangle with ambient light, as a fraction of the image width"},
      {"ambient_top", &S::ambient_top, 0, 1, "",
       "upper edge of the rectangle with ambient light, as a fraction of the image height"},
      {"ambient_right", &S::ambient_right, 0, 1, "",
       "right edge of the rectangle with ambient light, as a fraction of the image width"},
      {"ambient_bottom", &S::ambient_bottom, 0, 1, "",
       "lower edge of the rectangle with ambient light, as a fraction of the image height"},
      {"phase_bits", &S::phase_bits, 0, 16, "",
       "rounds phases to 2^bits steps per cycle, with 4 bits or more; 0: no rounding"},
      {"b_delay_share", &S::b_delay_share, 0, 1, "",
       "time from the first image of a frame to the last, as a fraction of the frame period"},
      {"frames", &S::frames, 0, 1000000, "",
       "number of frames to record; 0: as many as the path needs"},
      {"frame_rate_hz", &S::frame_rate_hz, 0.01, 10000, "Hz", "frames per second"},
      {"max_translation_m", &S::max_translation_m, 0.001, 10, "m",
       "largest translation of the camera from frame to frame"},
      {"max_rotation_deg", &S::max_rotation_deg, 0.01, 90, "deg",
       "largest rotation of the camera from frame to frame"},
      // Truth images hold millimetres in 16 bits.
      {"max_range_m", &S::max_range_m, 0, 65.5, "m",
       "surfaces beyond return no signal, and the recording states this limit; 0: no limit"},
      {"trajectory_file", &S::trajectory_file, 0, 0, "",
       "file of camera poses in TUM format, one per frame; empty: the path of the scene"},
      {"walk", &S::walk, 0, 2147483647, "",
       "seed of another walk through the scene; 0: the path of the scene"},
      {"rearranged", &S::rearranged, 0, 50, "",
       "number of pieces of furniture that are taken away, put in anew or moved, in turn"},
      {"arrangement", &S::arrangement, 0, 2147483647, "", "seed of what is rearranged, and where"},
      {"people", &S::people, 0, 8, "", "largest number of people who walk about"},
      {"people_paths", &S::people_paths, 0, 0, "",
       "where people walk: ahead of the camera, on lines of their own, or alternately"},
      {"people_range_m", &S::people_range_m, 0.8, 10, "m",
       "mean range from the camera to the nearest person ahead of it"},
      {"doors", &S::doors, 0, 8, "", "largest number of doors that open and shut"},
      {"seed", &S::seed, 0, 2147483647, "",
       "seed of the noise, of people and doors, and of the scene random"},
  };
}

SimulatorOptions checked_options(SimulatorOptions options) {
  OptionTable table;
  SimulatorOptions copy = options;
  table.bind("simulator", copy);
  for (const OptionField<SimulatorOptions>& field : SimulatorOptions::fields()) {
    if (const auto* whole = std::get_if<int SimulatorOptions::*>(&field.member)) {
      table.set("simulator." + std::string(field.name), std::to_string(options.*(*whole)));
    } else if (const auto* number = std::get_if<double SimulatorOptions::*>(&field.member)) {
      const double value = options.*(*number);
      if (!(value >= field.min && value <= field.max)) {
        table.set("simulator." + std::string(field.name), std::to_string(value));
      }
    } else if (const auto* list =
                   std::get_if<std::vector<double> SimulatorOptions::*>(&field.member)) {
      for (const double value : options.*(*list)) {
        table.set("simulator." + std::string(field.name), std::to_string(value));
      }
    }
  }
  check_lists(options);
  check_systematic_errors(options);
  return options;
}

Modulation modulation_of(const SimulatorOptions& options) {
  if (options.frequencies_hz.empty()) return {options.frequency_a_hz, options.frequency_b_hz};
  Modulation modulation;
  modulation.frequencies_hz = options.frequencies_hz;
  return modulation;
}

}  // namespace tofmap
