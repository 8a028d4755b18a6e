// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/room_map.hpp>

namespace tofmap {

/// The record of a frame as a row of a map file, and back. The row has what reports tell of a
/// frame, not its covariances. frame_record() throws InputError if the row is damaged.
FrameRow frame_row(const FrameRecord& record, int recording);
FrameRecord frame_record(const FrameRow& row);

}  // namespace tofmap
