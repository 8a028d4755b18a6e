// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// Writes the state of an interrupted run into `folder` as `state.bin`, so that resume_run() can
/// continue it later. `source` is the recording that the run reads, `options` are the run's
/// options; both are stored to recognise them. Throws InputError if the file cannot be written
/// whole.
void write_run_state(const std::filesystem::path& folder, const MapRun& run,
                     const SequenceReader& source, PipelineOptions options);

/// Resumes the interrupted run of a result folder: fills `run`, and moves `source` to the first
/// frame that is not processed yet. Does nothing if the folder does not exist. Throws InputError if
/// the folder holds no interrupted run, if its state is damaged or from another build, or if the
/// run is of another recording. Throws UsageError if the run had another camera or other options.
/// The messages say what to do.
void resume_run(const std::filesystem::path& folder, MapRun& run, SequenceReader& source,
                PipelineOptions options);

}  // namespace tofmap
