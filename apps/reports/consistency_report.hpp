// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/watched_source.hpp"

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// Every consistency measure under its name, null if it is unknown.
nlohmann::ordered_json consistency_json(const Consistency& consistency);

/// The verdict on a map, the reasons why it is not better, and remarks.
nlohmann::ordered_json judgement_json(const Judgement& judgement);

/// The warnings about a recording or device, then those about the map that was made of it.
std::vector<std::string> all_warnings(const SourceSurvey& source, const RoomMap& map,
                                      const Consistency& consistency);

}  // namespace tofmap::app
