// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/unwrap_options.hpp"

#include <array>

namespace tofmap {
namespace {

using Method = NamedValue<UnwrapMethod>;
constexpr std::array methods{
    Method{"joint", UnwrapMethod::joint}, Method{"jump", UnwrapMethod::jump},
    Method{"paper", UnwrapMethod::paper}, Method{"single", UnwrapMethod::single},
    Method{"pixel", UnwrapMethod::pixel}, Method{"none", UnwrapMethod::none}};

}  // namespace

std::vector<OptionField<UnwrapOptions>> UnwrapOptions::fields() {
  using O = UnwrapOptions;
  return {
      {"method", &O::method, 0, 0, "", "method that finds the wrap counts"},
      {"max_range_m", &O::max_range_m, 0, 100000, "m",
       "longest range in the scene, which limits the wrap counts; 0: the limit that the recording "
       "states, or else the range up to which the frequencies are unambiguous; paper always "
       "uses two wrap counts"},
      {"count_iterations", &O::count_iterations, 1, 1000, "",
       "joint: iterations of belief propagation over wrap counts"},
      {"scales", &O::scales, 1, 6, "",
       "joint: largest number of pyramid levels: pixels, blocks of 2 x 2, of 4 x 4 and so on; "
       "coarser levels are used only in noisy frames; 1: only pixels"},
      {"outlier_share", &O::outlier_share, 1e-6, 0.99, "",
       "joint: probability that a pixel's residual comes from no surface"},
      {"slope_m", &O::slope_m, 0.001, 10, "m",
       "joint: typical difference between the true ranges of neighbouring pixels on one surface"},
      {"amplitude_edges", &O::amplitude_edges, 0, 1, "",
       "joint: an edge between surfaces is more probable where the amplitude changes"},
      {"mixed_pixels", &O::mixed_pixels, 0, 1, "",
       "joint: ignore the residual of mixed pixels, those whose amplitude lies between the "
       "amplitudes of two opposite neighbours"},
      {"fuse_frequencies", &O::fuse_frequencies, 0, 1, "",
       "joint: the range is the mean of all frequencies, weighted by inverse variances; false: "
       "the range of the first one"},
      {"correct_exposure", &O::correct_exposure, 0, 1, "",
       "joint, jump: estimate the camera's motion between the exposures of the frequencies and "
       "correct for it; no effect without systematic_errors"},
      {"systematic_errors", &O::systematic_errors, 0, 1, "",
       "joint, jump: estimate the systematic errors in which the frequencies differ, from all "
       "frames so far; false: residuals are attributed to noise alone"},
      {"pair_first", &O::pair_first, 0, 8, "",
       "jump, paper, single: the frequency whose phase jumps are found, counted from 1; 0: of the "
       "pair that is unambiguous up to the longest range"},
      {"pair_second", &O::pair_second, 0, 8, "",
       "jump, paper: the frequency with which it is compared, counted from 1; 0: as for "
       "pair_first"},
      {"iterations", &O::iterations, 1, 1000, "",
       "jump, paper, single: largest number of iterations of belief propagation"},
      {"trust_discontinuity", &O::trust_discontinuity, 0, 1, "",
       "jump, paper, single: c_d, trust in the term that compares the phases of neighbouring "
       "pixels"},
      {"trust_frequency", &O::trust_frequency, 0, 1, "",
       "jump, paper: c_f, trust in the term that compares the two frequencies"},
      {"window_px", &O::window_px, 1, 99, "px",
       "jump, paper: k, pixels on each side of a phase jump over which medians are taken"},
      {"sigma_cycles", &O::sigma_cycles, 0.001, 10, "cycles",
       "jump, single: sigma, standard deviation of the true phase differences between "
       "neighbouring pixels, without noise"},
      {"objection_share", &O::objection_share, 0, 1e6, "",
       "jump: two regions stay separate if joining them raises the cost of their residuals by more "
       "than this factor times the log odds of the phase jump between them"},
  };
}

std::span<const NamedValue<UnwrapMethod>> named_values(UnwrapMethod) { return methods; }

bool finds_jumps(UnwrapMethod method) {
  return method == UnwrapMethod::paper || method == UnwrapMethod::jump ||
         method == UnwrapMethod::single;
}

}  // namespace tofmap
