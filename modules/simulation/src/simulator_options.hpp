// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

/// Checks every option as the command line does, since callers may fill the struct in code. Throws
/// UsageError.
SimulatorOptions checked_options(SimulatorOptions options);

/// The modulation frequencies of the options.
Modulation modulation_of(const SimulatorOptions& options);

}  // namespace tofmap
