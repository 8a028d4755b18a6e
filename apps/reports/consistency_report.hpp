// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>

namespace tofmap::app {

/// Every consistency measure under its name, null if it is unknown.
nlohmann::ordered_json consistency_json(const Consistency& consistency);

/// The verdict on a map, the reasons why it is not better, and remarks.
nlohmann::ordered_json judgement_json(const Judgement& judgement);

}  // namespace tofmap::app
