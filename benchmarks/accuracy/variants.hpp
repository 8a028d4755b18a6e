// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/unwrap.hpp>

// An inner part of the module: the paper's method, whose departures are left out one at a time.
#include "jump/jump.hpp"

namespace tofmap::accuracy {

/// Options, and a method of phase jumps that none of them names.
struct Variant {
  std::string name;
  UnwrapOptions options = {};
  std::optional<JumpMethod> jumps = std::nullopt;
};

/// Unwraps the frames of one run, in order, after a look ahead at the first of them, as the program
/// does it.
using UnwrapFrame = std::function<UnwrapResult(const DualFrequencyFrame&)>;
UnwrapFrame unwrapper_of(const Variant& variant, const SensorModel& sensor,
                         const std::vector<DualFrequencyFrame>& frames);

/// Every method by its name.
std::vector<Variant> methods();

/// `joint` with one ingredient less, or more of one.
std::vector<Variant> ablations();

/// One departure from the paper after the other, until it is `jump`.
std::vector<Variant> departures();

/// `jump` with one of its departures from the paper taken back.
std::vector<Variant> returns();

}  // namespace tofmap::accuracy
