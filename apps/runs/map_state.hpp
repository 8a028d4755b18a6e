// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// Writes what an interrupted run needs to go on into a result folder. Throws InputError if it
/// cannot be written whole.
void write_map_state(const std::filesystem::path& folder, const MapRun& run,
                     const SequenceReader& source, PipelineOptions options);

/// Goes on where the interrupted run of a result folder ended: fills `run` and moves the recording
/// to its next frame. A folder that is not there is a run that has not begun. Throws InputError if
/// the folder holds no interrupted run, or one of another recording, UsageError if it is of other
/// options; both say what to do.
void take_up_map(const std::filesystem::path& folder, MapRun& run, SequenceReader& source,
                 PipelineOptions options);

}  // namespace tofmap::app
