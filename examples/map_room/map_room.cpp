// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Maps three frames of a simulated room, scores the trajectory against the truth, and draws the
// map.

#include <cstdio>

#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/visualization/map_pictures.hpp>

int main() {
  tofmap::SimulatorOptions options;
  options.width_px = 44;
  options.height_px = 36;
  options.frames = 3;
  tofmap::Simulator camera(tofmap::make_scene("room"), options);
  const tofmap::RoomMap map = tofmap::map_room(camera, {});
  const auto score = tofmap::score_trajectory(map.trajectory, camera.trajectory());
  if (!score) return 1;
  std::printf("%d frames registered, path error %.4f m, %zu map points\n", score->matched,
              score->ate_rmse_m, map.surface.points.size());
  const tofmap::GravityAlignedFrame frame =
      tofmap::gravity_aligned_frame(map.surface, map.trajectory);
  const tofmap::Picture picture = tofmap::map_from_above(map.surface, map.trajectory, frame, 200);
  tofmap::write_picture("map.png", picture);
  return score->matched == 3 && score->ate_rmse_m < 0.1 ? 0 : 1;
}
