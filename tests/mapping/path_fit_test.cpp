// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/path_fit.hpp"

#include "support/box_room.hpp"

#include <limits>
#include <memory>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Information = Eigen::Matrix<double, 6, 6>;
using Twist = Eigen::Matrix<double, 6, 1>;

constexpr int frames = 60;
constexpr int frames_per_keyframe = 20;
constexpr double frame_sigma_m = 0.004;  // and radians
constexpr double keyframe_sigma_m = 0.01;

/// A path with a keyframe every 20 frames. Each keyframe but the first is off by one draw of noise;
/// each frame was registered with the keyframes before and after it, with noise of its own.
class FittedPath : public testing::Test {
 protected:
  FittedPath() {
    content_.recordings.emplace_back();
    for (int i = 0; i <= frames; i += frames_per_keyframe) add_keyframe(i);
    for (int i = 0; i <= frames; ++i) add_frame(i);
  }

  static Pose true_pose(int frame) {
    return test::moved_by({0, 0.02 * frame, 0}, {0.03 * frame, 0, 0.01 * frame});
  }

  void add_keyframe(int frame) {
    const Twist noise = frame == 0 ? Twist(Twist::Zero()) : draw(keyframe_sigma_m);
    const int id = content_.keyframes.size();
    content_.keyframes.add({.id = id,
                            .frame_index = frame,
                            .timestamp_s = frame / 15.0,
                            .world_from_camera = moved_by(noise, true_pose(frame)),
                            .cloud = cloud_});
    if (id == 0) return;
    PoseEdge edge{.from = id - 1, .to = id};
    edge.from_from_to = pose(id - 1).inverse() * pose(id);
    edge.covariance *= keyframe_sigma_m * keyframe_sigma_m;
    content_.edges.push_back(edge);
  }

  void add_frame(int i) {
    const int before = std::min(i / frames_per_keyframe, content_.keyframes.size() - 2);
    const bool is_last = i == frames;
    RegisteredFrame frame{
        .timestamp_s = i / 15.0, .keyframe = before + (is_last ? 1 : 0), .index = i};
    frame.keyframe_from_camera =
        pose(frame.keyframe).inverse() * moved_by(draw(frame_sigma_m), true_pose(i));
    if (i % frames_per_keyframe == 0) {
      frame.keyframe_from_camera = Pose::Identity();
      if (i > 0)
        frame.constraints.push_back(
            constraint_of(content_.edges[static_cast<std::size_t>(frame.keyframe) - 1]));
    } else {
      for (const int keyframe : {before, before + 1}) {
        frame.constraints.push_back(constraint(keyframe, i, draw(frame_sigma_m)));
      }
    }
    content_.frames.push_back(frame);
  }

  /// What a registration with a keyframe tells that finds the frame off by `error`.
  static FrameConstraint constraint(int keyframe, int frame, const Twist& error) {
    const Pose keyframe_from_world = true_pose(frames_per_keyframe * keyframe).inverse();
    FrameConstraint constraint{.keyframe = keyframe};
    constraint.keyframe_from_camera =
        Eigen::Isometry3f((keyframe_from_world * moved_by(error, true_pose(frame))).cast<float>());
    constraint.information =
        Eigen::Matrix<float, 6, 6>::Identity() / static_cast<float>(frame_sigma_m * frame_sigma_m);
    return constraint;
  }

  /// The constraint of the frame of a keyframe from the registration that its edge is from.
  static FrameConstraint constraint_of(const PoseEdge& edge) {
    FrameConstraint constraint{.keyframe = edge.from};
    constraint.keyframe_from_camera = Eigen::Isometry3f(edge.from_from_to.cast<float>());
    constraint.information = edge.covariance.inverse().cast<float>();
    return constraint;
  }

  Twist draw(double sigma) {
    return Twist::NullaryExpr([&] { return sigma * normal_(random_); });
  }

  const Pose& pose(int keyframe) const { return content_.keyframes[keyframe].world_from_camera; }

  void fit(std::size_t held = 0) { fit_path(content_, 0, {}, motion_, held); }

  double keyframe_error_m(int keyframe) const {
    return (pose(keyframe).translation() - true_pose(frames_per_keyframe * keyframe).translation())
        .norm();
  }

  double rms_error_m() const {
    double sum = 0;
    for (const RegisteredFrame& frame : content_.frames) {
      sum +=
          (pose_of(frame, content_.keyframes).translation() - true_pose(frame.index).translation())
              .squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(content_.frames.size()));
  }

  const MotionUncertainty motion_{0.03, 0.03};
  std::mt19937 random_{3};
  std::normal_distribution<double> normal_;
  std::shared_ptr<const SurfaceCloud> cloud_ = std::make_shared<const SurfaceCloud>(
      test::box_cloud(test::small_camera(), {-1, -1, -1}, {1, 1, 2}, Pose::Identity()));
  MapContent content_{test::small_camera(), {}};
};

TEST_F(FittedPath, PutsKeyframesWhereTheFramesAroundThemSay) {
  EXPECT_GT(rms_error_m(), 0.007);
  fit();
  // 19 frames tell the pose of a keyframe relative to the one before it to √3 · 4 mm · √(2 / 19).
  EXPECT_LT(keyframe_error_m(1), 0.004);
  EXPECT_LT(keyframe_error_m(2), 0.006);
  // Frames keep the noise of two constraints each: √3 · 4 mm / √2.
  EXPECT_LT(rms_error_m(), 0.0055);
}

TEST_F(FittedPath, KnowsFromTheGradientWhereSurfacesWouldPutAFrame) {
  MapContent moved = content_;
  Twist offset;
  offset << 0.002, -0.003, 0.001, 0.005, 0.004, -0.006;
  for (RegisteredFrame& frame : moved.frames) {
    for (FrameConstraint& constraint : frame.constraints) {
      const Pose found(constraint.keyframe_from_camera.cast<double>());
      constraint.keyframe_from_camera = Eigen::Isometry3f(moved_by(offset, found).cast<float>());
      constraint.gradient = constraint.information * offset.cast<float>();
    }
  }
  fit();
  fit_path(moved, 0, {}, motion_, 0);
  for (int id = 0; id < content_.keyframes.size(); ++id) {
    // Rotations commute up to the product of both.
    EXPECT_LT(twist_between(pose(id), moved.keyframes[id].world_from_camera).norm(), 2e-4) << id;
  }
}

TEST_F(FittedPath, MovesNoKeyframeThatIsHeld) {
  const Pose first = pose(0);
  const Pose second = pose(1);
  const double error_m = keyframe_error_m(2);
  fit(2);
  EXPECT_EQ(first.matrix(), pose(0).matrix());
  EXPECT_EQ(second.matrix(), pose(1).matrix());
  EXPECT_NE(keyframe_error_m(2), error_m);
}

TEST_F(FittedPath, KeepsWhatItFindsInTheEdgesOfOdometry) {
  fit();
  for (const PoseEdge& edge : content_.edges) {
    EXPECT_LT(twist_between(pose(edge.from) * edge.from_from_to, pose(edge.to)).norm(), 1e-9);
  }
}

TEST_F(FittedPath, LeavesOutConstraintsThatAreFarOff) {
  MapContent undisturbed = content_;
  content_.frames[30].constraints.push_back(
      constraint(1, 30, (Twist() << 0, 0, 0, 0.5, 0, 0).finished()));
  fit();
  fit_path(undisturbed, 0, {}, motion_, 0);
  EXPECT_LT(twist_between(pose(1), undisturbed.keyframes[1].world_from_camera).norm(), 1e-9);
}

TEST_F(FittedPath, TakesNegativeInformationForNoise) {
  // Nothing is known along the z-axes of keyframes, which differ. All of them know of y.
  const auto error_y_m = [&](int keyframe) {
    return std::abs(pose(keyframe).translation().y() -
                    true_pose(frames_per_keyframe * keyframe).translation().y());
  };
  for (RegisteredFrame& frame : content_.frames) {
    for (FrameConstraint& constraint : frame.constraints) constraint.information(5, 5) *= -1;
  }
  const double z_m = pose(1).translation().z();
  const double before_m = error_y_m(1) + error_y_m(2) + error_y_m(3);
  fit();
  // Without any of these frames, it would stay.
  EXPECT_LT(error_y_m(1) + error_y_m(2) + error_y_m(3), 0.75 * before_m);
  // The edges of odometry hold z, but for turns of the keyframes.
  EXPECT_NEAR(pose(1).translation().z(), z_m, 0.01);
}

TEST_F(FittedPath, LeavesOutDirectionsWhoseMinimumIsFarOff) {
  MapContent undisturbed = content_;
  for (std::size_t i = 21; i < 30; ++i) {
    FrameConstraint& constraint = content_.frames[i].constraints.front();
    FrameConstraint& other = undisturbed.frames[i].constraints.front();
    // Nothing holds the frame along z, but for a slope that noise has made.
    for (FrameConstraint* one : {&constraint, &other}) {
      one->information.row(5).setZero();
      one->information.col(5).setZero();
    }
    constraint.information(5, 5) = 10;
    constraint.gradient[5] = -30;
  }
  fit();
  fit_path(undisturbed, 0, {}, motion_, 0);
  EXPECT_LT(twist_between(pose(1), undisturbed.keyframes[1].world_from_camera).norm(), 1e-9);
}

/// Lets surfaces tell nothing of where frames and keyframes are along the x-axis, from frame 25 on
/// and before frame 55, and moves all of these there by a draw of noise of 5 cm.
class BareWall : public FittedPath {
 protected:
  BareWall() {
    open_edges();
    for (RegisteredFrame& frame : content_.frames) {
      if (!is_open(frame.index)) continue;
      if (is_of_keyframe(frame)) {
        move(frame.keyframe);
      } else {
        frame.keyframe_from_camera =
            Eigen::Translation3d(draw_slide_m(), 0, 0) * frame.keyframe_from_camera;
        frame.covariance(3, 3) = 1;
      }
      for (FrameConstraint& constraint : frame.constraints) {
        constraint.information.row(3).setZero();
        constraint.information.col(3).setZero();
      }
    }
  }

  static bool is_open(int frame) { return frame >= 25 && frame < 55; }

  bool is_of_keyframe(const RegisteredFrame& frame) const {
    return content_.keyframes[frame.keyframe].frame_index == frame.index;
  }

  double draw_slide_m() { return 0.05 * draw(1)[0]; }

  void move(int keyframe) {
    content_.keyframes.set_pose(keyframe,
                                pose(keyframe) * Eigen::Translation3d(draw_slide_m(), 0, 0));
  }

  void open_edges() {
    for (PoseEdge& edge : content_.edges) {
      if (is_open(frames_per_keyframe * edge.to) || is_open(frames_per_keyframe * edge.from)) {
        edge.covariance(3, 3) = 1;
      }
    }
  }
};

TEST_F(BareWall, IsPassedSteadily) {
  EXPECT_GT(rms_error_m(), 0.03);
  EXPECT_GT(keyframe_error_m(2), 0.02);
  fit();
  // A fourth of the slides, whose mean nothing tells but the frames beside the wall.
  EXPECT_LT(keyframe_error_m(2), 0.0125);
  EXPECT_LT(rms_error_m(), 0.0125);
}

TEST_F(FittedPath, LeavesKeyframesWhereTheyAreWithoutConstraints) {
  for (RegisteredFrame& frame : content_.frames) frame.constraints.clear();
  const MapContent before = content_;
  fit();
  for (int id = 0; id < content_.keyframes.size(); ++id) {
    EXPECT_LT(twist_between(before.keyframes[id].world_from_camera, pose(id)).norm(), 1e-9) << id;
  }
  for (std::size_t i = 0; i < content_.frames.size(); ++i) {
    EXPECT_LT(twist_between(before.frames[i].keyframe_from_camera,
                            content_.frames[i].keyframe_from_camera)
                  .norm(),
              1e-9)
        << i;
  }
}

TEST_F(FittedPath, StaysWhereItIsWithNumbersThatNothingCanBeComputedWith) {
  for (RegisteredFrame& frame : content_.frames) {
    for (FrameConstraint& constraint : frame.constraints) {
      constraint.information(0, 0) = std::numeric_limits<float>::infinity();
    }
  }
  const MapContent before = content_;
  fit();
  for (int id = 0; id < content_.keyframes.size(); ++id) {
    EXPECT_EQ(before.keyframes[id].world_from_camera.matrix(), pose(id).matrix()) << id;
  }
}

TEST_F(FittedPath, LeavesEdgesThatAreFromNoConstraint) {
  // An edge that was found otherwise, and is bent by the frames between its keyframes.
  for (RegisteredFrame& frame : content_.frames) {
    if (frame.index == 2 * frames_per_keyframe) frame.constraints.clear();
  }
  const MapContent before = content_;
  fit();
  EXPECT_EQ(before.edges[1].from_from_to.matrix(), content_.edges[1].from_from_to.matrix());
  EXPECT_NE(before.edges[0].from_from_to.matrix(), content_.edges[0].from_from_to.matrix());
}

TEST_F(FittedPath, UsesWhatFramesOfEarlierRecordingsTell) {
  content_.recordings.emplace_back();
  MapContent alone = content_;
  for (RegisteredFrame& frame : alone.frames) frame.constraints.clear();
  fit_path(content_, 1, {}, motion_, 0);
  fit_path(alone, 1, {}, motion_, 0);
  EXPECT_LT(keyframe_error_m(1), 0.004);
  EXPECT_LT(twist_between(alone.keyframes[1].world_from_camera, pose(1)).norm(), 0.05);
  EXPECT_GT(twist_between(alone.keyframes[1].world_from_camera, pose(1)).norm(), 0.005);
}

TEST_F(FittedPath, FollowsLoopsThatAreUsedAlone) {
  // A loop that says that the last keyframe is 3 cm farther to the right.
  PoseEdge edge{.from = 0, .to = 3, .may_be_wrong = true};
  edge.from_from_to = Eigen::Translation3d(0.03, 0, 0) * (pose(0).inverse() * pose(3));
  edge.covariance *= 1e-8;
  content_.edges.push_back(edge);
  content_.loops.push_back({.from_frame = 0, .to_frame = frames, .is_used = false});
  MapContent used = content_;
  used.loops.front().is_used = true;
  const double before_m = pose(3).translation().x();
  LoopOptions options;
  options.kernel_width = 1e6;
  fit_path(content_, 0, options, motion_, 0);
  fit_path(used, 0, options, motion_, 0);
  EXPECT_NEAR(used.keyframes[3].world_from_camera.translation().x(), before_m + 0.03, 0.002);
  EXPECT_LT(keyframe_error_m(3), 0.008);
}

TEST(FrameConstraint, HoldsAlongTheAxesOfItsKeyframe) {
  Keyframe keyframe{.id = 4};
  keyframe.world_from_camera = test::moved_by({0.3, -0.5, 0.2}, {1, 2, 3});
  RegistrationResult registration;
  registration.world_from_camera = test::moved_by({0.1, 0.2, 0.3}, {2, 2, 1});
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.01, -0.02, 0.03, 0.1, 0.2, -0.1;
  TargetEquations equations;
  equations.information.diagonal() << 1, 2, 3, 4, 5, 6;
  equations.information(0, 4) = equations.information(4, 0) = 0.5;
  equations.gradient << 1, -2, 3, -4, 5, -6;
  registration.target_equations = {equations};
  const Keyframe* const target = &keyframe;
  const auto constraints = constraints_of(registration, {&target, 1});
  ASSERT_EQ(constraints.size(), 1U);
  EXPECT_EQ(constraints[0].keyframe, 4);
  EXPECT_TRUE(
      (keyframe.world_from_camera * Pose(constraints[0].keyframe_from_camera.cast<double>()))
          .isApprox(registration.world_from_camera, 1e-6));
  // The cost of an error is the same along any axes.
  const Eigen::Matrix<double, 6, 1> along =
      rotated_twist(twist, keyframe.world_from_camera.linear().transpose());
  EXPECT_NEAR(along.dot(constraints[0].information.cast<double>() * along),
              twist.dot(equations.information * twist), 1e-6);
  EXPECT_NEAR(along.dot(constraints[0].gradient.cast<double>()), twist.dot(equations.gradient),
              1e-6);
}

}  // namespace
}  // namespace tofmap
