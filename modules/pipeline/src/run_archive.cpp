// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How a MapRun is put aside and taken up again.

#include "tofmap/pipeline/pipeline.hpp"

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/string.hpp>

#include <tofmap/mapping/archive.hpp>

namespace boost::serialization {

template <class Archive>
void serialize(Archive& archive, tofmap::FilterCount& count, unsigned) {
  archive& count.name& count.reason& count.removed& count.corrected;
}

template <class Archive>
void serialize(Archive& archive, tofmap::StageTimes& times, unsigned) {
  archive& times.unwrap_ms& times.filter_ms& times.cloud_ms;
  archive& times.register_ms& times.map_ms& times.loop_ms;
}

template <class Archive>
void serialize(Archive& archive, tofmap::FrameRecord& record, unsigned) {
  archive& record.index& record.timestamp_s& record.damage& record.repeats& record.iterations;
  archive& record.curl_violations& record.phase_noise_cycles& record.valid_pixels;
  archive& record.kept_pixels& record.filters& record.tracking& record.times;
}

}  // namespace boost::serialization

namespace tofmap {

void MapRun::save(std::ostream& out) const {
  {
    boost::archive::binary_oarchive archive(out);
    archive << frames_;
  }
  measurer_.save(out);
  mapper_.save(out);
}

void MapRun::load(std::istream& in) {
  {
    boost::archive::binary_iarchive archive(in);
    archive >> frames_;
  }
  ahead_.clear();
  measurer_.load(in);
  mapper_.load(in);
}

}  // namespace tofmap
