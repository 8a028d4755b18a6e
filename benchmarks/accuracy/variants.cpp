// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "variants.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace tofmap::accuracy {

namespace {

std::span<const Frame> first_of(const std::vector<Frame>& frames) {
  return {frames.data(), std::min<std::size_t>(frames.size(), FrameMeasurer::frames_ahead)};
}

}  // namespace

UnwrapFrame unwrapper_of(const Variant& variant, const SensorModel& sensor,
                         const std::vector<Frame>& frames) {
  if (!variant.jumps) {
    const auto unwrapper = std::make_shared<Unwrapper>(sensor, variant.options);
    unwrapper->look_ahead(first_of(frames));
    return [unwrapper](const auto& frame) { return unwrapper->unwrap(frame); };
  }
  FrameMeasurer informed(sensor, variant.options);
  informed.look_ahead(first_of(frames));
  return [variant, measurer = std::move(informed),
          limits = unwrap_limits(sensor, variant.options.max_range_m).pair(0, 1),
          estimator = JumpEstimator()](const auto& frame) mutable {
    return unwrap_by_jumps(estimator, measurer.measure(frame), limits, *variant.jumps,
                           variant.options);
  };
}

std::vector<Variant> methods() {
  std::vector<Variant> variants;
  for (const char* name : {"none", "pixel", "single", "paper", "jump", "joint"}) {
    variants.push_back({name, {}});
    variants.back().options.method = find_named<UnwrapMethod>(name).value();
  }
  return variants;
}

std::vector<Variant> ablations() {
  const auto variant = [](const char* name, const std::function<void(UnwrapOptions&)>& change) {
    Variant made{name, {}};
    change(made.options);
    return made;
  };
  return {
      variant("joint", [](UnwrapOptions&) {}),
      variant("no coarser scales", [](auto& o) { o.scales = 1; }),
      variant("edges in amplitude not used", [](auto& o) { o.amplitude_edges = false; }),
      variant("mixed pixels not modelled", [](auto& o) { o.mixed_pixels = false; }),
      variant("no outliers", [](auto& o) { o.outlier_share = 1e-4; }),
      variant("surfaces face the camera (1 cm)", [](auto& o) { o.slope_m = 0.01; }),
      variant("1 iteration", [](auto& o) { o.count_iterations = 1; }),
      variant("10 iterations", [](auto& o) { o.count_iterations = 10; }),
      variant("ranges from A alone", [](auto& o) { o.fuse_frequencies = false; }),
  };
}

std::vector<Variant> departures() {
  std::vector<Variant> steps{{"paper", {}, JumpMethod{}}};
  const auto then = [&](const char* name, const std::function<void(JumpMethod&)>& depart) {
    steps.push_back(steps.back());
    steps.back().name = name;
    depart(*steps.back().jumps);
  };
  then("+ σ of slopes", [](JumpMethod& m) { m.has_sigma_of_image = false; });
  then("+ noise of pixels", [](JumpMethod& m) { m.has_noise_of_pixels = true; });
  then("+ all counts", [](JumpMethod& m) { m.has_all_counts = true; });
  then("+ sweeps together", [](JumpMethod& m) { m.schedule = MessageSchedule::together; });
  then("+ anchors by the residual", [](JumpMethod& m) { m.regards_residual = true; });
  steps.back().options.objection_share = 1e6;
  then("+ objection: `jump`", [](JumpMethod&) {});
  steps.back().options.objection_share = 1;
  return steps;
}

std::vector<Variant> returns() {
  const auto variant = [](const char* name, const std::function<void(JumpMethod&)>& change) {
    Variant made{name, {}, jump_method(UnwrapMethod::jump)};
    change(*made.jumps);
    return made;
  };
  return {
      variant("jump", [](JumpMethod&) {}),
      variant("σ of the image, no noise",
              [](JumpMethod& m) {
                m.has_sigma_of_image = true;
                m.has_noise_of_pixels = false;
              }),
      variant("no noise", [](JumpMethod& m) { m.has_noise_of_pixels = false; }),
      variant("two counts", [](JumpMethod& m) { m.has_all_counts = false; }),
      variant("sweeps one by one", [](JumpMethod& m) { m.schedule = MessageSchedule::one_by_one; }),
      variant("residual not used", [](JumpMethod& m) { m.regards_residual = false; }),
  };
}

}  // namespace tofmap::accuracy
