// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/unwrap/unwrap.hpp>

// A private header of the module: the method of the paper, with switches for the departures from
// it.
#include "jump/jump.hpp"

namespace tofmap::accuracy {

/// A variant of a method.
struct Variant {
  std::string name;
  UnwrapOptions options = {};
  /// If not empty, a method of phase jumps that is used instead of `options.method`.
  std::optional<JumpMethod> jumps = std::nullopt;
};

/// A function that unwraps the frames of one run, to be called in order.
using UnwrapFrame = std::function<UnwrapResult(const Frame&)>;

/// Returns the function for a variant, after it has looked ahead at the first frames as the program
/// does.
UnwrapFrame unwrapper_of(const Variant& variant, const SensorModel& sensor,
                         const std::vector<Frame>& frames);

/// Every method, under its name.
std::vector<Variant> methods();

/// Variants of `joint` with one part removed or changed.
std::vector<Variant> ablations();

/// Variants from `paper` to `jump`, each with one more departure from the paper.
std::vector<Variant> departures();

/// Variants of `jump`, each with one departure from the paper undone.
std::vector<Variant> returns();

}  // namespace tofmap::accuracy
