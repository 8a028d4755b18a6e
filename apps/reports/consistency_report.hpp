// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <tofmap/diagnostics/consistency.hpp>

namespace tofmap::app {

/// Every consistency measure under its name, null if it is unknown.
nlohmann::ordered_json consistency_json(const Consistency& consistency);

}  // namespace tofmap::app
