// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// Writes what an interrupted run needs to go on later into the folder, as `state.bin`. Throws
/// InputError if the file cannot be written whole.
void write_run_state(const std::filesystem::path& folder, const MapRun& run,
                     const SequenceReader& source, PipelineOptions options);

/// Resumes the interrupted run of a result folder: fills `run`, and moves the recording to the next
/// frame. Does nothing if the folder does not exist, as before the first run. Throws InputError if
/// the folder holds no interrupted run or that of another recording, and UsageError if that run had
/// other options. Both say what to do.
void resume_run(const std::filesystem::path& folder, MapRun& run, SequenceReader& source,
                PipelineOptions options);

}  // namespace tofmap
