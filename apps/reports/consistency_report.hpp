// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/consistency.hpp"

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace tofmap::app {

/// What is more than right maps mostly have, in sentences.
std::vector<std::string> doubts_about(const Consistency& consistency);

nlohmann::ordered_json consistency_json(const Consistency& consistency);

}  // namespace tofmap::app
