// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// Brings the file of a map up to date with a run, in one commit: the map, and what resume_run()
/// needs to continue the run later. `sample` has frames of the run, which are in the file alone
/// afterwards (FrameSample::bring_back()). `source` is the recording that the run reads, `options`
/// are the run's options; both are stored to recognise them. Throws InputError if the file cannot
/// be written.
void store_run(MapStore& store, MapRun& run, FrameSample& sample, const SequenceReader& source,
               const PipelineOptions& options);

/// Brings the file of a map up to date with a run that cannot be resumed, such as that of a device.
void store_map(MapStore& store, MapRun& run);

/// Stores the map of a run that has ended, removes what resume_run() needs, and shrinks the file.
void complete_map(MapStore& store, MapRun& run);

/// Whether a file holds a run that resume_run() may continue: it was stored at least once, and not
/// completed.
bool holds_run(const MapStore& store);

/// Resumes the run of a file: fills `run` and `sample`, and moves `source` to the first frame that
/// is not processed yet. Throws InputError if the file holds no interrupted run, if it is damaged
/// or written by another version of the program, or if the run is of another recording. Throws
/// UsageError if the run had another camera or other options. The messages say what to do.
void resume_run(const MapStore& store, MapRun& run, FrameSample& sample, SequenceReader& source,
                const PipelineOptions& options);

}  // namespace tofmap
