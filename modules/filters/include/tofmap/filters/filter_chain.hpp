// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

struct FilterOptions {
  std::string chain = "amplitude confidence phasor_mean isolated_wrap plane_edge";
  double min_amplitude = 0;
  double min_confidence = 0;
  double min_phasor_noise_cycles = 0.1;
  double max_phasor_radius_px = 16;
  double max_isolated_share = 0.01;
  double max_edge_angle_deg = 170;
  double min_edge_gap_sigmas = 5;
  double max_step_incidence_deg = 80;
  double min_step_sigmas = 3;
  double max_plane_sigmas = 3.2;
  double max_edge_sigmas = 1.5;
  double plane_tolerance_m = 0.03;
  double max_smooth_sigmas = 3;
  double smooth_tolerance_m = 0.005;
  double max_outlier_deviations = 5;

  static std::vector<OptionField<FilterOptions>> fields();
};

/// The default chain where ranges are the result: smoothed in the end. Maps are made of planes
/// fitted to them, which is the better smoothing, and noise that neighbours share already would
/// look like shape.
std::string smoothing_chain();

/// What one filter of the chain did.
struct FilterCount {
  std::string name;
  InvalidReason reason = InvalidReason::none;
  int removed = 0;
  int corrected = 0;  ///< pixels that got another wrap count
};

struct FilterResult {
  RangeImage image;
  std::vector<FilterCount> counts;  ///< in the order of the chain
};

/// The names of all filters, with `separator` between them.
std::string filter_names(const std::string& separator);

/// Applies the filters named in `options.chain`, in that order. Throws UsageError for a name
/// that is none of filter_names().
FilterResult apply_filters(const RangeImage& image, const DualFrequencyFrame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const FilterOptions& options);

}  // namespace tofmap
