// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// The name of the file that holds the state of an interrupted run in a result folder.
inline constexpr const char* run_state_file = "state.bin";

/// The state of an interrupted run as the bytes of a run_state_file, from which resume_run() can
/// continue it later. `sample` has frames of the run. `source` is the recording that the run reads,
/// `options` are the run's options; both are stored to recognise them.
std::string run_state(const MapRun& run, const FrameSample& sample, const SequenceReader& source,
                      PipelineOptions options);

/// Resumes the interrupted run of a result folder: fills `run` and `sample`, and moves `source` to
/// the first frame that is not processed yet. Does nothing if the folder does not exist. Throws
/// InputError if the folder holds no interrupted run, if its state is damaged or from another
/// build, or if the run is of another recording. Throws UsageError if the run had another camera or
/// other options. The messages say what to do.
void resume_run(const std::filesystem::path& folder, MapRun& run, FrameSample& sample,
                SequenceReader& source, PipelineOptions options);

}  // namespace tofmap
