// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// Reads and checks sequence.yaml. Throws InputError, which names the file, the key and what is
/// expected, if the file cannot be read or is not valid.
SensorModel read_sequence_header(const std::filesystem::path& file);

/// The text of sequence.yaml for a sensor. Every number reads back as the same bits.
std::string sequence_header_text(const SensorModel& sensor);

}  // namespace tofmap
