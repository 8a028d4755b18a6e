// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "temporary_folder.hpp"

#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::test {

/// A map file in a folder of its own, in which a run is put aside.
class StoredMap {
 public:
  MapStore& store() const { return store_; }

  void save(MapRun& run, FrameSample* sample = nullptr) const {
    MapStore::Commit commit(store_);
    run.save(commit);
    if (sample != nullptr) sample->save(commit);
    commit.finish();
  }

  void save(const FrameSample& sample) const {
    MapStore::Commit commit(store_);
    sample.save(commit);
    commit.finish();
  }

 private:
  TemporaryFolder folder_;
  mutable MapStore store_ = MapStore::create(folder_.path() / map_file_name);
};

}  // namespace tofmap::test
