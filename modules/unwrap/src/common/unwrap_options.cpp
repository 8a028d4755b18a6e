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
      {"method", &O::method, 0, 0, "", "how wraps are found"},
      {"max_range_m", &O::max_range_m, 0, 100000, "m",
       "farthest range that the scene can hold; 0: the recording's, else what the pair can tell "
       "apart; paper has two counts, whatever it is"},
      {"count_iterations", &O::count_iterations, 1, 1000, "",
       "joint: iterations of belief propagation over counts"},
      {"scales", &O::scales, 1, 6, "",
       "joint: pixels, blocks of 2 x 2, of 4 x 4 ... where noise asks for it; 1: pixels alone"},
      {"outlier_share", &O::outlier_share, 1e-6, 0.99, "",
       "joint: share of a pixel's evidence that may come from no surface at all"},
      {"slope_m", &O::slope_m, 0.001, 10, "m",
       "joint: typical difference of true ranges between neighbours on a surface"},
      {"amplitude_edges", &O::amplitude_edges, 0, 1, "",
       "joint: a change of amplitude makes an edge likelier"},
      {"mixed_pixels", &O::mixed_pixels, 0, 1, "",
       "joint: a pixel with an amplitude between those of opposite neighbours has two surfaces, "
       "and "
       "is left to them"},
      {"fuse_frequencies", &O::fuse_frequencies, 0, 1, "",
       "joint: ranges from both frequencies, weighted by their noise, not from A alone"},
      {"correct_exposure", &O::correct_exposure, 0, 1, "",
       "joint, jump: allow for the camera's motion from A's exposure to B's"},
      {"systematic_errors", &O::systematic_errors, 0, 1, "",
       "joint, jump: estimate what the frequencies disagree by, over the frames so far; 0: noise "
       "alone explains it"},
      {"iterations", &O::iterations, 1, 1000, "",
       "jump, paper, single: most iterations of belief propagation"},
      {"trust_discontinuity", &O::trust_discontinuity, 0, 1, "",
       "jump, paper, single: c_d, trust in phases of neighbours being close"},
      {"trust_frequency", &O::trust_frequency, 0, 1, "",
       "jump, paper: c_f, trust in the difference of the two frequencies"},
      {"window_px", &O::window_px, 1, 99, "px",
       "jump, paper: k, pixels on each side of a jump in the medians"},
      {"sigma_cycles", &O::sigma_cycles, 0.001, 10, "cycles",
       "jump, single: sigma of f_d and f_f: of true differences between neighbours; noise comes on "
       "top"},
      {"objection_share", &O::objection_share, 0, 1e6, "",
       "jump: regions stay apart where the residual objects by more than this share of a jump's "
       "log "
       "odds"},
  };
}

std::span<const NamedValue<UnwrapMethod>> named_values(UnwrapMethod) { return methods; }

bool finds_jumps(UnwrapMethod method) {
  return method == UnwrapMethod::paper || method == UnwrapMethod::jump ||
         method == UnwrapMethod::single;
}

}  // namespace tofmap
