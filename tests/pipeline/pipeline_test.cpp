// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/stored_map.hpp"

// Composition: what holds of the whole, whatever its stages do.

#include <algorithm>

#include <gtest/gtest.h>
#include <omp.h>

#include <tofmap/core/error.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/mapping/moving_regions.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::test {
namespace {

constexpr int total_frames = 6;

Simulator small_room() {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.frames = total_frames;
  return {make_scene("room"), options};
}

/// A recording with a damaged frame at this index.
class DamagedSource final : public FrameSource {
 public:
  DamagedSource(const Simulator& simulator, int damaged_index)
      : simulator_(simulator), damaged_index_(damaged_index) {}

  const SensorModel& sensor() const override { return simulator_.sensor(); }
  std::optional<int> frame_count() const override { return total_frames; }
  std::optional<SourcedFrame> next() override {
    if (index_ == total_frames) return {};
    SourcedFrame out;
    out.index = index_;
    Frame frame = simulator_.simulate(index_).frame;
    out.timestamp_s = frame.timestamp_s;
    if (index_ == damaged_index_) {
      out.damage = "b/000003.png: truncated";
    } else {
      out.frame = std::move(frame);
    }
    ++index_;
    return out;
  }

 private:
  const Simulator& simulator_;
  int damaged_index_;
  int index_ = 0;
};

class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() { omp_set_num_threads(before_); }

 private:
  int before_;
};

TEST(MapRoom, PlacesEveryFrameOfAWholeRecording) {
  Simulator room = small_room();
  const RoomMap map = map_room(room, {});
  EXPECT_EQ(map.frames.size(), total_frames);
  EXPECT_EQ(map.trajectory.size(), total_frames);
  EXPECT_FALSE(map.keyframes.empty());
  EXPECT_FALSE(map.surface.empty());
  EXPECT_FALSE(map.interrupted);
  EXPECT_EQ(map.registered_slowly, 0);
}

TEST(MapRoom, CountsFramesThatTookMostOfTheIterationsAllowed) {
  Simulator room = small_room();
  PipelineOptions options;
  options.registration.max_iterations = 1;
  const RoomMap map = map_room(room, options);
  ASSERT_FALSE(map.trajectory.empty());
  EXPECT_EQ(map.registered_slowly, map.trajectory.size() - 1) << "the first frame is the origin";
}

/// Along a corridor only its far end and a few edges say how far the camera went.
TEST(MapRoom, FollowsTheCameraDownACorridor) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.frames = 20;
  Simulator corridor(make_scene("corridor"), options);
  const RoomMap map = map_room(corridor, {});
  const TrajectoryScore score = score_trajectory(map.trajectory, corridor.trajectory()).value();
  EXPECT_EQ(score.matched, 20);
  EXPECT_GT(score.length_m, 0.8);
  // Measured: 1 mm. Where the corridor's length is left to the prior, the camera stays behind by
  // decimetres.
  EXPECT_LT(score.ate_rmse_m, 0.01);
}

/// Every field of every point.
void expect_same_bits(const MapCloud& a, const MapCloud& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].getVector3fMap(), b[i].getVector3fMap()) << i;
    ASSERT_EQ(a[i].getNormalVector3fMap(), b[i].getNormalVector3fMap()) << i;
    ASSERT_EQ(a[i].confidence, b[i].confidence) << i;
    ASSERT_EQ(a[i].observations, b[i].observations) << i;
  }
}

void expect_same_bits(const RoomMap& a, const RoomMap& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const FrameTracking& one = a.frames[i].tracking;
    const FrameTracking& other = b.frames[i].tracking;
    EXPECT_EQ(one.registration.residual_scale, other.registration.residual_scale) << i;
    EXPECT_EQ(one.registration.overlap, other.registration.overlap) << i;
    EXPECT_EQ(one.registration.rmse_m, other.registration.rmse_m) << i;
    EXPECT_EQ(one.registration.iterations, other.registration.iterations) << i;
    EXPECT_EQ(one.status, other.status) << i;
    EXPECT_EQ(one.is_keyframe, other.is_keyframe) << i;
    EXPECT_EQ(a.frames[i].kept_pixels, b.frames[i].kept_pixels) << i;
    EXPECT_EQ(a.frames[i].filters.size(), b.frames[i].filters.size()) << i;
    EXPECT_EQ(a.frames[i].phase_noise_cycles, b.frames[i].phase_noise_cycles) << i;
  }
  EXPECT_EQ(a.keyframes.size(), b.keyframes.size());
  EXPECT_EQ(a.loops.size(), b.loops.size());
  ASSERT_EQ(a.trajectory.size(), b.trajectory.size());
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    EXPECT_EQ(a.trajectory[i].world_from_camera.matrix(),
              b.trajectory[i].world_from_camera.matrix())
        << i;
  }
  expect_same_bits(a.surface, b.surface);
}

TEST(MapRoom, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto mapped_by = [](int threads) {
    const Threads limit(threads);
    SimulatorOptions options;
    options.frames = 5;
    // Correspondences are found by several threads only where there are more than 4000 points.
    options.width_px = 176;
    options.height_px = 144;
    Simulator room(make_scene("room"), options);
    return map_room(room, {});
  };
  const RoomMap one = mapped_by(1);
  const RoomMap four = mapped_by(4);
  ASSERT_GT(one.frames.back().tracking.registration.correspondences, 4000);
  expect_same_bits(one, four);
}

TEST(MapRoom, SkipsADamagedFrameAndSaysSo) {
  const Simulator room = small_room();
  DamagedSource source(room, 3);
  const RoomMap map = map_room(source, {});
  ASSERT_EQ(map.frames.size(), total_frames);
  EXPECT_EQ(map.damaged(), 1);
  EXPECT_EQ(map.frames[3].damage, "b/000003.png: truncated");
  EXPECT_EQ(map.trajectory.size(), total_frames - 1);
}

/// A camera that shows one image for ever from the third frame on.
class StuckSource final : public FrameSource {
 public:
  explicit StuckSource(const Simulator& simulator) : simulator_(simulator) {}

  const SensorModel& sensor() const override { return simulator_.sensor(); }
  std::optional<int> frame_count() const override { return total_frames; }
  std::optional<SourcedFrame> next() override {
    if (index_ == total_frames) return {};
    return at(index_++);
  }

  SourcedFrame at(int index) const {
    SourcedFrame out;
    out.index = index;
    Frame frame = simulator_.simulate(std::min(index, 2)).frame;
    frame.index = index;
    frame.timestamp_s = simulator_.simulate(index).frame.timestamp_s;
    out.timestamp_s = frame.timestamp_s;
    out.frame = std::move(frame);
    return out;
  }

 private:
  const Simulator& simulator_;
  int index_ = 0;
};

TEST(MapRoom, CountsFramesThatRepeat) {
  const Simulator simulator = small_room();
  StuckSource source(simulator);
  const RoomMap map = map_room(source, {});
  ASSERT_EQ(map.frames.size(), static_cast<std::size_t>(total_frames));
  EXPECT_EQ(map.repeated(), total_frames - 3);
  EXPECT_FALSE(map.frames[0].repeats || map.frames[2].repeats);
  EXPECT_TRUE(map.frames[3].repeats);
  EXPECT_EQ(map.frames[3].tracking.status, TrackingStatus::repeated);
  EXPECT_EQ(map.trajectory.size(), 3U) << "the pose of the camera is unknown while frames repeat";
}

TEST(MapRun, KnowsAfterItWasPutAsideWhichFrameWasTheLast) {
  const Threads limit(1);
  const Simulator simulator = small_room();
  constexpr int frames_before = 3;
  const test::StoredMap aside;
  {
    StuckSource source(simulator);
    MapRun run(source.sensor(), {});
    MapHooks hooks;
    hooks.keep_going = [](int done) { return done < frames_before; };
    run.advance(source, hooks);
    aside.save(run);
  }
  StuckSource source(simulator);
  for (int i = 0; i < frames_before; ++i) source.next();
  MapRun run(source.sensor(), {});
  run.load(aside.store(), [&](int index) { return source.at(index); });
  run.advance(source);
  EXPECT_EQ(run.finish().repeated(), total_frames - 3);
}

/// Delivers one frame `copies` times.
class FrozenSource final : public FrameSource {
 public:
  FrozenSource(const Simulator& simulator, int copies)
      : sensor_(simulator.sensor()), frame_(simulator.simulate(0).frame), copies_(copies) {}

  const SensorModel& sensor() const override { return sensor_; }
  std::optional<int> frame_count() const override { return copies_; }
  std::optional<SourcedFrame> next() override {
    if (index_ == copies_) return {};
    SourcedFrame out;
    out.index = frame_.index = index_;
    out.timestamp_s = frame_.timestamp_s = index_ / 15.0;
    out.frame = frame_;
    ++index_;
    return out;
  }

 private:
  SensorModel sensor_;
  Frame frame_ = blank_frame(2);
  int copies_;
  int index_ = 0;
};

TEST(MapRoom, CountsCopiesOfAFrameOnce) {
  const Simulator simulator = small_room();
  FrozenSource one(simulator, 1);
  FrozenSource many(simulator, 6);
  const MapCloud of_one = map_room(one, {}).surface;
  const MapCloud of_many = map_room(many, {}).surface;
  ASSERT_FALSE(of_one.empty());
  ASSERT_EQ(of_many.size(), of_one.size());
  for (std::size_t i = 0; i < of_one.size(); ++i) {
    EXPECT_EQ(of_many[i].observations, of_one[i].observations);
  }
}

TEST(PrepareRanges, AreThoseOfTheWholeFrame) {
  const Simulator simulator = small_room();
  const Frame frame = simulator.simulate(0).frame;
  const SensorModel& sensor = simulator.sensor();
  const PixelRays rays = pixel_rays(sensor.camera);
  const PipelineOptions options;
  Unwrapper unwrapper(sensor, options.unwrap);
  FrameMeasurer measurer(sensor, options.unwrap);
  const TimedMeasurement measured = measure_frame(frame, measurer);
  const PreparedFrame whole = prepare_frame(measured, unwrapper, sensor, rays, options);
  const PreparedFrame ranges = prepare_ranges(measured, unwrapper, sensor, rays, options);
  EXPECT_TRUE(whole.cloud);
  EXPECT_FALSE(ranges.cloud);
  EXPECT_TRUE((ranges.unwrapped.image.wrap_count == whole.unwrapped.image.wrap_count).all());
  EXPECT_TRUE((ranges.filtered.image.reason == whole.filtered.image.reason).all());
  EXPECT_TRUE(same_values(ranges.filtered.image.range_m, whole.filtered.image.range_m));
}

TEST(MapRoom, EndsEarlyWithWhatItHasWhenToldTo) {
  const Threads limit(1);  // frames are taken by as many as there are threads
  Simulator room = small_room();
  MapHooks hooks;
  hooks.keep_going = [](int done) { return done < 2; };
  const RoomMap map = map_room(room, {}, hooks);
  EXPECT_TRUE(map.interrupted);
  EXPECT_EQ(map.frames.size(), 2);
  EXPECT_EQ(map.trajectory.size(), 2);
  EXPECT_FALSE(map.surface.empty());
}

SourcedFrame sourced(const Simulator& simulator, int index) {
  return {.index = index,
          .timestamp_s = simulator.simulate(index).frame.timestamp_s,
          .frame = simulator.simulate(index).frame,
          .damage = ""};
}

TEST(MapRun, GoesOnToTheSameBitsAfterItWasPutAside) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.frames = 24;
  const Scene scene = make_scene("room");
  Simulator at_once_source(scene, options);
  const RoomMap at_once = map_room(at_once_source, {});

  Simulator source(scene, options);
  const test::StoredMap aside;
  {
    MapRun run(source.sensor(), {});
    MapHooks hooks;
    hooks.keep_going = [](int done) { return done < 10; };
    run.advance(source, hooks);
    EXPECT_TRUE(run.is_interrupted());
    aside.save(run);
  }
  MapRun run(source.sensor(), {});
  run.load(aside.store(), [&](int index) { return sourced(source, index); });
  run.advance(source);
  const RoomMap resumed = run.finish();

  EXPECT_FALSE(resumed.interrupted);
  expect_same_bits(resumed, at_once);
}

/// A run with a sample of its frames.
struct SampledRun {
  static constexpr int frames = 30;

  MapRun run;
  FrameSample sample;

  explicit SampledRun(const SensorModel& sensor)
      : run(sensor, {}), sample(sensor.camera, frames, frames) {}

  void advance(Simulator& source, int end) {
    MapHooks hooks;
    hooks.keep_going = [end](int done) { return done < end; };
    hooks.on_frame = [this](const Frame& recorded, const PreparedFrame& prepared) {
      sample.add(recorded, prepared);
    };
    hooks.on_motion = [this](int index, const SurfaceCloud& still) {
      sample.drop_moving(index, still);
    };
    run.advance(source, hooks);
  }
};

TEST(MapRun, GoesOnToTheSameConsistencyAfterItWasPutAside) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.people = 1;
  const Scene scene = make_scene("room");
  Simulator source_at_once(scene, options);
  const SensorModel sensor = source_at_once.sensor();
  SampledRun at_once(sensor);
  at_once.advance(source_at_once, SampledRun::frames);

  Simulator source(scene, options);
  const test::StoredMap aside;
  {
    SampledRun begun(sensor);
    begun.advance(source, 14);
    aside.save(begun.run, &begun.sample);
  }
  SampledRun resumed(sensor);
  resumed.run.load(aside.store(), [&](int index) { return sourced(source, index); });
  resumed.sample.load(aside.store(), static_cast<int>(resumed.run.frames().size()));
  resumed.advance(source, SampledRun::frames);

  EXPECT_EQ(resumed.run.errors().frames, at_once.run.errors().frames);
  EXPECT_EQ(resumed.run.errors().flow_px, at_once.run.errors().flow_px);
  const Consistency expected =
      consistency_of(at_once.run.finish(), at_once.sample, sensor, UnwrapMethod::joint);
  const Consistency found =
      consistency_of(resumed.run.finish(), resumed.sample, sensor, UnwrapMethod::joint);
  EXPECT_GT(expected.contradicted_percent, 0);
  EXPECT_EQ(found.contradicted_percent, expected.contradicted_percent);
  EXPECT_EQ(found.residual_misfit_percent, expected.residual_misfit_percent);
  EXPECT_EQ(found.residual_rms_cycles, expected.residual_rms_cycles);
  EXPECT_EQ(found.ambiguous_percent, expected.ambiguous_percent);
  EXPECT_EQ(found.plane_thickness_m, expected.plane_thickness_m);
  EXPECT_EQ(found.view_disagreement_m, expected.view_disagreement_m);
}

TEST(MapRun, KeepsNoSampledFrameInMemoryThatIsInTheFile) {
  Simulator source = small_room();
  const CameraModel& camera = source.sensor().camera;
  SampledRun run(source.sensor());
  run.advance(source, total_frames);
  FrameSample& sample = run.sample;
  const std::vector<SampledFrame> before = sample.frames();
  const test::StoredMap file;
  const auto put_aside = [&] {
    file.save(sample);
    sample.note_saved(file.store());
    EXPECT_THROW(sample.frames(), UsageError);
  };

  put_aside();
  sample.bring_back();
  ASSERT_EQ(sample.frames().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const SampledFrame& after = sample.frames()[i];
    EXPECT_EQ(after.recorded.index, before[i].recorded.index);
    for (std::size_t f = 0; f < before[i].recorded.phases.size(); ++f) {
      EXPECT_TRUE(same_values(after.recorded.phases[f], before[i].recorded.phases[f])) << i;
      EXPECT_TRUE(same_values(after.returns.phases[f], before[i].returns.phases[f])) << i;
    }
    EXPECT_TRUE(same_values(after.filtered.range_m, before[i].filtered.range_m)) << i;
  }

  // A frame that was put aside is changed, and put aside again.
  SurfacePoint moving{};
  moving.getVector3fMap().setConstant(1);
  moving.confidence = moving_confidence;
  const SurfaceCloud all_moves(static_cast<std::uint32_t>(camera.width_px),
                               static_cast<std::uint32_t>(camera.height_px), moving);
  put_aside();
  sample.drop_moving(2, all_moves);
  put_aside();
  sample.bring_back();
  ASSERT_EQ(sample.frames().size(), before.size());
  EXPECT_TRUE(sample.frames()[2].filtered.range_m.isNaN().all());
  EXPECT_TRUE(same_values(sample.frames()[1].filtered.range_m, before[1].filtered.range_m));

  put_aside();
  MapStore::Commit commit(file.store());
  commit.remove("run/sample/");
  commit.finish();
  EXPECT_THROW(sample.bring_back(), InputError) << "they cannot be read any more";
  EXPECT_TRUE(sample.frames().empty());
}

TEST(MapRoom, ShowsEveryReadableFrameInOrder) {
  const Simulator room = small_room();
  DamagedSource source(room, 2);
  std::vector<int> seen;
  MapHooks hooks;
  hooks.on_frame = [&](const Frame& recorded, const PreparedFrame& frame) {
    EXPECT_EQ(recorded.index, frame.index);
    seen.push_back(frame.index);
  };
  map_room(source, {}, hooks);
  EXPECT_EQ(seen, (std::vector{0, 1, 3, 4, 5}));
}

TEST(FramesAgree, IfNearlyAllAreInOneMapWithoutContradictions) {
  RoomMap map;
  map.frames.resize(100);
  map.trajectory.resize(95);
  Consistency consistency = unknown_consistency();
  EXPECT_FALSE(frames_agree(map, consistency)) << "no place was seen twice";
  consistency.contradicted_percent = 1;
  EXPECT_TRUE(frames_agree(map, consistency));
  consistency.contradicted_percent = 5;
  EXPECT_FALSE(frames_agree(map, consistency));
  consistency.contradicted_percent = 1;
  map.trajectory.resize(94);
  EXPECT_FALSE(frames_agree(map, consistency)) << "too few are registered";
  map.trajectory.resize(100);
  map.registered_slowly = 4;
  EXPECT_TRUE(frames_agree(map, consistency));
  map.registered_slowly = 5;
  EXPECT_FALSE(frames_agree(map, consistency)) << "some were found slowly";
  map.registered_slowly = 0;
  map.separate_maps.resize(1);
  EXPECT_FALSE(frames_agree(map, consistency)) << "in several maps";
}

TEST(MapRoom, OfARecordingWithoutReturnsIsEmpty) {
  class Darkness final : public FrameSource {
   public:
    explicit Darkness(const SensorModel& sensor) : sensor_(sensor) {}
    const SensorModel& sensor() const override { return sensor_; }
    std::optional<int> frame_count() const override { return 2; }
    std::optional<SourcedFrame> next() override {
      if (index_ == 2) return {};
      Frame frame = blank_frame(2);
      frame.index = index_;
      frame.timestamp_s = index_;
      frame.phases[0] = frame.phases[1] =
          ImageF::Constant(sensor_.camera.height_px, sensor_.camera.width_px, NAN);
      return SourcedFrame{index_++, frame.timestamp_s, frame, ""};
    }

   private:
    SensorModel sensor_;
    int index_ = 0;
  };
  Darkness source(small_room().sensor());
  const RoomMap map = map_room(source, {});
  EXPECT_EQ(map.frames.size(), 2);
  EXPECT_TRUE(map.trajectory.empty());
  EXPECT_TRUE(map.surface.empty());
}

}  // namespace
}  // namespace tofmap::test
