// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/rearrangement.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr std::array<int, 5> seeds{1, 2, 3, 4, 5};
constexpr int some = 9;

/// The coordinates of the corners of a triangle.
using Corners = std::array<float, 9>;

Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  Corners corners{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f& vertex = mesh.vertices[mesh.triangles[triangle][i]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corners[3 * i + axis] = vertex[static_cast<Eigen::Index>(axis)];
    }
  }
  return corners;
}

/// How often each triangle is in a mesh.
std::map<Corners, int> triangles_of(const TriangleMesh& mesh) {
  std::map<Corners, int> triangles;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) ++triangles[corners_of(mesh, i)];
  return triangles;
}

/// How often each triangle is more often in one mesh than in another.
std::map<Corners, int> difference(const TriangleMesh& mesh, const TriangleMesh& other) {
  std::map<Corners, int> more = triangles_of(mesh);
  for (const auto& [corners, count] : triangles_of(other)) {
    const auto found = more.find(corners);
    if (found == more.end()) continue;
    found->second -= count;
    if (found->second <= 0) more.erase(found);
  }
  return more;
}

/// The mesh of one piece.
TriangleMesh mesh_of(const Scene& scene, const MeshPart& part) {
  TriangleMesh mesh;
  mesh.vertices = scene.surface.vertices;
  mesh.reflectance = scene.surface.reflectance;
  for (std::size_t i = 0; i < part.triangles; ++i) {
    mesh.triangles.push_back(scene.surface.triangles[part.first_triangle + i]);
  }
  return mesh;
}

/// The mesh of all but some pieces.
TriangleMesh mesh_without(const Scene& scene, const std::set<std::size_t>& pieces) {
  TriangleMesh mesh = scene.surface;
  std::vector<bool> is_kept(mesh.triangles.size(), true);
  for (const std::size_t index : pieces) {
    const MeshPart& part = scene.furniture[index].part;
    for (std::size_t i = 0; i < part.triangles; ++i) is_kept[part.first_triangle + i] = false;
  }
  mesh.triangles.clear();
  for (std::size_t i = 0; i < is_kept.size(); ++i) {
    if (is_kept[i]) mesh.triangles.push_back(scene.surface.triangles[i]);
  }
  return mesh;
}

bool is_placed(const FurniturePiece& piece) {
  return piece.state == PieceState::added || piece.state == PieceState::moved;
}

bool is_removed(const FurniturePiece& piece) {
  return piece.state == PieceState::gone || piece.state == PieceState::moved;
}

/// A piece with all that carries it and all that stands on it or beside it there.
std::set<std::size_t> stack_of(const Scene& scene, std::size_t piece) {
  std::size_t lowest = piece;
  while (scene.furniture[lowest].on >= 0) {
    lowest = static_cast<std::size_t>(scene.furniture[lowest].on);
  }
  std::set<std::size_t> stack{lowest};
  for (std::size_t i = 0; i < scene.furniture.size(); ++i) {
    const int on = scene.furniture[i].on;
    if (on >= 0 && stack.contains(static_cast<std::size_t>(on))) stack.insert(i);
  }
  return stack;
}

/// Whether an edge of one mesh above a height crosses a surface. Two surfaces that intersect have
/// an edge of one that crosses the other.
bool has_crossing_edge(const TriangleMesh& mesh, const RayScene& surface, double above_m) {
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3d from = mesh.vertices[triangle[i]].cast<double>();
      const Vector3d edge = mesh.vertices[triangle[(i + 1) % 3]].cast<double>() - from;
      if (std::max(from.z(), from.z() + edge.z()) <= above_m) continue;
      // The part of an edge that begins on the floor.
      const double start = edge.z() > 0 && from.z() < above_m ? (above_m - from.z()) / edge.z() : 0;
      const double end =
          edge.z() < 0 && from.z() + edge.z() < above_m ? (above_m - from.z()) / edge.z() : 1;
      if (surface.cast(from + start * edge, edge.normalized(), (end - start) * edge.norm())) {
        return true;
      }
    }
  }
  return false;
}

int count_of(const Scene& scene, PieceState state) {
  return static_cast<int>(std::ranges::count(scene.furniture, state, &FurniturePiece::state));
}

class Furniture : public testing::TestWithParam<std::string> {};
class RearrangedScene : public testing::TestWithParam<std::string> {};

const auto scene_of_test = [](const auto& instance) { return instance.param; };
INSTANTIATE_TEST_SUITE_P(Each, Furniture, testing::ValuesIn(scene_names()), scene_of_test);
INSTANTIATE_TEST_SUITE_P(Each, RearrangedScene, testing::ValuesIn(scene_names()), scene_of_test);

TEST_P(Furniture, HasVerticesOfItsOwnAndDifferentNames) {
  const Scene scene = make_scene(GetParam());
  if (GetParam() != "wall" && GetParam() != "slope") {
    EXPECT_GE(scene.furniture.size(), 3U);
  }
  std::set<std::string> names;
  for (const FurniturePiece& piece : scene.furniture) {
    EXPECT_TRUE(names.insert(piece.name).second) << piece.name;
    EXPECT_GT(piece.part.triangles, 0U);
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < scene.surface.triangles.size(); ++i) {
      const bool is_of_piece =
          i >= piece.part.first_triangle && i < piece.part.first_triangle + piece.part.triangles;
      for (const std::uint32_t vertex : scene.surface.triangles[i]) {
        const bool is_its_vertex = vertex >= piece.part.first_vertex &&
                                   vertex < piece.part.first_vertex + piece.part.vertices;
        EXPECT_EQ(is_its_vertex, is_of_piece) << piece.name;
        if (is_of_piece) box.extend(scene.surface.vertices[vertex].cast<double>());
      }
    }
    EXPECT_TRUE(box.isApprox(piece.box)) << piece.name;
    EXPECT_TRUE(box.isApprox(piece.box_before)) << piece.name;
  }
}

TEST_P(Furniture, RestsOnTheFloorOrOnWhatCarriesIt) {
  const Scene scene = make_scene(GetParam());
  for (const FurniturePiece& piece : scene.furniture) {
    if (piece.on == FurniturePiece::on_wall) {
      EXPECT_GT(piece.box.min().z(), 0.3) << piece.name;
      continue;
    }
    const double below_m =
        piece.on < 0 ? 0 : scene.furniture.at(static_cast<std::size_t>(piece.on)).box.max().z();
    EXPECT_NEAR(piece.box.min().z(), below_m, 1e-6) << piece.name;
  }
}

TEST_P(RearrangedScene, IsTheSameIfNothingIsRearranged) {
  const Scene scene = make_scene(GetParam());
  const Scene same = rearranged(scene, 0, 5);
  EXPECT_EQ(same.surface.vertices, scene.surface.vertices);
  EXPECT_EQ(same.surface.reflectance, scene.surface.reflectance);
  EXPECT_EQ(same.surface.triangles, scene.surface.triangles);
  EXPECT_EQ(rearranged_count(same.furniture), 0);
}

TEST_P(RearrangedScene, IsDeterminedByTheSeed) {
  const Scene scene = make_scene(GetParam());
  const Scene one = rearranged(scene, some, 1);
  const Scene again = rearranged(scene, some, 1);
  EXPECT_EQ(one.surface.vertices, again.surface.vertices);
  EXPECT_EQ(one.surface.triangles, again.surface.triangles);
  if (GetParam() == "slope") return;  // it has no floor
  EXPECT_NE(one.surface.vertices, rearranged(scene, some, 2).surface.vertices);
}

TEST_P(RearrangedScene, DiffersInTheTrianglesOfThePiecesThatChanged) {
  const Scene before = make_scene(GetParam());
  for (const int seed : seeds) {
    const Scene after = rearranged(before, some, seed);
    std::map<Corners, int> removed;
    std::map<Corners, int> placed;
    for (std::size_t i = 0; i < after.furniture.size(); ++i) {
      const FurniturePiece& piece = after.furniture[i];
      if (is_removed(piece)) {
        for (const auto& [corners, count] :
             triangles_of(mesh_of(before, before.furniture[i].part))) {
          removed[corners] += count;
        }
      }
      if (is_placed(piece)) {
        for (const auto& [corners, count] : triangles_of(mesh_of(after, piece.part))) {
          placed[corners] += count;
        }
      }
    }
    EXPECT_EQ(difference(before.surface, after.surface), removed) << "seed " << seed;
    EXPECT_EQ(difference(after.surface, before.surface), placed) << "seed " << seed;
  }
}

TEST_P(RearrangedScene, KnowsWhereItsPiecesAreAndWere) {
  const Scene before = make_scene(GetParam());
  for (const int seed : seeds) {
    const Scene after = rearranged(before, some, seed);
    ASSERT_GE(after.furniture.size(), before.furniture.size());
    for (std::size_t i = 0; i < after.furniture.size(); ++i) {
      const FurniturePiece& piece = after.furniture[i];
      const bool is_new = i >= before.furniture.size();
      EXPECT_EQ(piece.state == PieceState::added, is_new) << piece.name;
      EXPECT_EQ(piece.box_before.isEmpty(), is_new) << piece.name;
      EXPECT_EQ(piece.box.isEmpty(), piece.state == PieceState::gone) << piece.name;
      EXPECT_EQ(piece.part.triangles == 0, piece.state == PieceState::gone) << piece.name;
      Eigen::AlignedBox3d box;
      for (const auto& triangle : mesh_of(after, piece.part).triangles) {
        for (const std::uint32_t vertex : triangle) {
          EXPECT_GE(vertex, piece.part.first_vertex) << piece.name;
          EXPECT_LT(vertex, piece.part.first_vertex + piece.part.vertices) << piece.name;
          box.extend(after.surface.vertices[vertex].cast<double>());
        }
      }
      if (!box.isEmpty()) {
        EXPECT_TRUE(box.isApprox(piece.box)) << piece.name;
      }
    }
  }
}

TEST_P(RearrangedScene, HasPiecesOfAllThreeKinds) {
  if (GetParam() == "slope") GTEST_SKIP() << "has no floor";
  const Scene before = make_scene(GetParam());
  for (const int seed : seeds) {
    const Scene after = rearranged(before, 3, seed);
    EXPECT_EQ(rearranged_count(after.furniture), 3) << "seed " << seed;
    const bool is_empty = before.furniture.empty();
    EXPECT_EQ(count_of(after, PieceState::added), is_empty ? 3 : 1) << "seed " << seed;
    EXPECT_EQ(count_of(after, PieceState::gone) > 0, !is_empty) << "seed " << seed;
    EXPECT_EQ(count_of(after, PieceState::moved) > 0, !is_empty) << "seed " << seed;
  }
}

TEST_P(RearrangedScene, HasNoPieceInAWallOrInAnotherPiece) {
  constexpr double floor_m = 0.051;  // above it, a piece touches nothing
  const Scene before = make_scene(GetParam());
  const RayScene old_surface(before.surface);
  for (const int seed : seeds) {
    const Scene after = rearranged(before, some, seed);
    for (std::size_t i = 0; i < after.furniture.size(); ++i) {
      const FurniturePiece& piece = after.furniture[i];
      if (!is_placed(piece)) continue;
      const TriangleMesh mesh = mesh_of(after, piece.part);
      const std::set<std::size_t> stack = stack_of(after, i);
      const TriangleMesh others = mesh_without(after, stack);
      EXPECT_FALSE(has_crossing_edge(mesh, RayScene(others), floor_m))
          << piece.name << ", seed " << seed;
      EXPECT_FALSE(has_crossing_edge(others, RayScene(mesh), floor_m))
          << piece.name << ", seed " << seed;
      // What was taken away does not make room for what is new.
      if (piece.state != PieceState::added) continue;
      EXPECT_FALSE(has_crossing_edge(mesh, old_surface, floor_m))
          << piece.name << ", seed " << seed;
    }
  }
}

TEST_P(RearrangedScene, LeavesThePathOfTheCameraFree) {
  const Scene before = make_scene(GetParam());
  for (const int seed : seeds) {
    const Scene after = rearranged(before, some, seed);
    for (const FurniturePiece& piece : after.furniture) {
      if (!is_placed(piece)) continue;
      const RayScene mesh(mesh_of(after, piece.part));
      for (double u = 0; u <= after.path.end(); u += 0.02) {
        EXPECT_GE(mesh.clearance_m(after.path.pose_at(u).translation(), 1), 0.48) << piece.name;
      }
    }
  }
}

TEST_P(RearrangedScene, MovesPiecesOnTheFloorByDecimetresToMetres) {
  const Scene before = make_scene(GetParam());
  for (const int seed : seeds) {
    const Scene after = rearranged(before, some, seed);
    for (const FurniturePiece& piece : after.furniture) {
      if (piece.state == PieceState::added) {
        EXPECT_NEAR(piece.box.min().z(), 0, 1e-5) << piece.name;
        EXPECT_EQ(piece.on, FurniturePiece::on_floor);
      }
      if (piece.state != PieceState::moved) continue;
      EXPECT_GE(piece.translation_m.norm(), 0.3) << piece.name;
      EXPECT_LE(piece.translation_m.norm(), 2.5) << piece.name;
      EXPECT_NEAR(piece.box.min().z(), piece.box_before.min().z(), 1e-5) << piece.name;
      EXPECT_NEAR(piece.box.max().z(), piece.box_before.max().z(), 1e-5) << piece.name;
      EXPECT_NE(piece.on, FurniturePiece::on_wall) << piece.name;
      if (piece.on < 0) {
        const Vector3d way = piece.box.center() - piece.box_before.center();
        // The centre of the box of a stack is not that of its lowest piece.
        EXPECT_NEAR((way - piece.translation_m).norm(), 0, 0.7) << piece.name;
      }
    }
  }
}

TEST_P(RearrangedScene, ShowsItsChanges) {
  if (GetParam() == "slope") GTEST_SKIP() << "has no floor";
  SimulatorOptions options;
  options.width_px = 44;
  options.height_px = 36;
  options.subpixels = 1;
  options.frames = 0;
  const Simulator before(make_scene(GetParam()), options);
  options.rearranged = 1;
  for (const int seed : seeds) {
    options.arrangement = seed;
    const Simulator after(make_scene(GetParam()), options);
    ASSERT_EQ(after.frame_count(), before.frame_count());
    Eigen::Index largest = 0;
    for (int i = 0; i < *after.frame_count(); i += 5) {
      const ImageF change_m =
          (after.simulate(i).range_truth_m - before.simulate(i).range_truth_m).abs();
      largest = std::max(largest, (change_m > 0.05F).count());
    }
    EXPECT_GE(largest, 2) << "seed " << seed;
  }
}

TEST(Rearrangement, TakesWhatAPieceCarriesAlong) {
  const Scene before = make_scene("room");
  int carriers_moved = 0;
  int carriers_gone = 0;
  for (int seed = 1; seed <= 40; ++seed) {
    const Scene after = rearranged(before, 6, seed);
    EXPECT_EQ(rearranged_count(after.furniture), 6);
    for (const FurniturePiece& piece : after.furniture) {
      if (piece.on < 0) continue;
      const FurniturePiece& carrier = after.furniture.at(static_cast<std::size_t>(piece.on));
      if (carrier.state == PieceState::same) continue;
      EXPECT_EQ(piece.state, carrier.state) << piece.name << ", seed " << seed;
      (carrier.state == PieceState::moved ? carriers_moved : carriers_gone) += 1;
      EXPECT_EQ(piece.translation_m, carrier.translation_m);
      EXPECT_EQ(piece.yaw_rad, carrier.yaw_rad);
      if (carrier.state != PieceState::moved) continue;
      EXPECT_TRUE(carrier.box.contains(
          Vector3d(piece.box.center().x(), piece.box.center().y(), carrier.box.center().z())));
    }
  }
  EXPECT_GT(carriers_moved, 0);
  EXPECT_GT(carriers_gone, 0);
}

TEST(Rearrangement, OfAnEmptyRoomPutsPiecesIn) {
  const Scene scene = rearranged(make_scene("wall"), 5, 1);
  EXPECT_EQ(count_of(scene, PieceState::added), 5);
  EXPECT_EQ(scene.furniture.size(), 5U);
}

TEST(Rearrangement, OfASceneWithoutFloorChangesNothing) {
  const Scene before = make_scene("slope");
  const Scene after = rearranged(before, 5, 1);
  EXPECT_EQ(rearranged_count(after.furniture), 0);
  EXPECT_EQ(after.surface.vertices, before.surface.vertices);
}

TEST(Rearrangement, OfAMeshFromAFilePutsPiecesIn) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "flat.ply";
  write_mesh_ply(file, make_scene("flat").surface);
  const Scene before = find_scene(file.string());
  const Scene after = rearranged(before, 4, 1);
  EXPECT_EQ(count_of(after, PieceState::added), 4);
  EXPECT_EQ(after.furniture.size(), 4U);
  EXPECT_TRUE(difference(before.surface, after.surface).empty());
}

TEST(Rearrangement, OfMoreThanThereIsEndsWhereNothingIsLeft) {
  const Scene after = rearranged(make_scene("corridor"), 50, 1);
  const int count = rearranged_count(after.furniture);
  EXPECT_GT(count, 3);
  EXPECT_LE(count, 50);
  EXPECT_LE(count_of(after, PieceState::gone) + count_of(after, PieceState::moved), 3);
}

TEST(Rearrangement, OfRandomRoomsNeedsNoFurniture) {
  for (int seed = 1; seed <= 30; ++seed) {
    const Scene before = make_scene("random", seed);
    const Scene after = rearranged(before, 6, seed);
    EXPECT_GT(rearranged_count(after.furniture), 0) << "room " << seed;
  }
}

TEST(Rearrangement, IsPartOfASimulationThatFollowsTheSamePath) {
  SimulatorOptions options;
  options.frames = 3;
  const Simulator before(make_scene("hall"), options);
  options.rearranged = 4;
  options.arrangement = 3;
  const Simulator after(make_scene("hall"), options);
  EXPECT_EQ(rearranged_count(before.furniture()), 0);
  EXPECT_EQ(rearranged_count(after.furniture()), 4);
  EXPECT_EQ(after.surface().vertices, rearranged(make_scene("hall"), 4, 3).surface.vertices);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(before.trajectory()[i].world_from_camera.matrix() ==
                after.trajectory()[i].world_from_camera.matrix());
  }
}

TEST(Rearrangement, RefusesOwnPosesThatLeadThroughAPiece) {
  const test::TemporaryFolder folder;
  SimulatorOptions options;
  options.rearranged = 3;
  const Scene scene = rearranged(make_scene("wall"), 3, options.arrangement);
  const Vector3d inside = scene.furniture.front().box.center();
  options.trajectory_file = (folder.path() / "poses.txt").string();
  write_trajectory(options.trajectory_file, {{0, look_along({0.9, 2.2, 1.5}, {1, 0, 0})},
                                             {1, look_along(inside, {1, 0, 0})}});
  try {
    const Simulator simulator(make_scene("wall"), options);
    ADD_FAILURE() << "accepted";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(scene.furniture.front().name));
    EXPECT_THAT(error.what(), testing::HasSubstr("arrangement"));
  }
  options.rearranged = 0;
  EXPECT_NO_THROW(Simulator(make_scene("wall"), options));
}

TEST(Rearrangement, RefusesOptionsThatAreNotAllowed) {
  const auto refused = [](const char* name, const auto& change) {
    SimulatorOptions options;
    change(options);
    try {
      const Simulator simulator(make_scene("wall"), options);
      ADD_FAILURE() << name << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(name));
    }
  };
  refused("rearranged", [](SimulatorOptions& o) { o.rearranged = -1; });
  refused("rearranged", [](SimulatorOptions& o) { o.rearranged = 51; });
  refused("arrangement", [](SimulatorOptions& o) { o.arrangement = -1; });
  refused("walk", [](SimulatorOptions& o) { o.walk = -1; });
}

TEST(FurnitureFile, TellsStateAndBoxesOfAllPieces) {
  const test::TemporaryFolder folder;
  const Scene scene = rearranged(make_scene("room"), 6, 1);
  write_furniture(folder.path() / "furniture.json", scene.furniture);
  std::ifstream in(folder.path() / "furniture.json");
  const nlohmann::json pieces = nlohmann::json::parse(in).at("pieces");
  ASSERT_EQ(pieces.size(), scene.furniture.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const FurniturePiece& piece = scene.furniture[i];
    EXPECT_EQ(pieces[i].at("name"), piece.name);
    EXPECT_EQ(pieces[i].at("state"), std::string(name_of(piece.state)));
    const auto expect_box = [&](const char* key, const Eigen::AlignedBox3d& box) {
      const nlohmann::json& written = pieces[i].at(key);
      ASSERT_EQ(written.is_null(), box.isEmpty()) << key;
      for (Eigen::Index axis = 0; axis < 3 && !box.isEmpty(); ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        EXPECT_NEAR(written.at("min_m")[at].get<double>(), box.min()[axis], 5.1e-5);
        EXPECT_NEAR(written.at("max_m")[at].get<double>(), box.max()[axis], 5.1e-5);
      }
    };
    expect_box("before", piece.box_before);
    expect_box("now", piece.box);
    EXPECT_EQ(pieces[i].contains("translation_m"), piece.state == PieceState::moved);
    EXPECT_EQ(pieces[i].contains("yaw_deg"), piece.state == PieceState::moved);
  }
  EXPECT_EQ(pieces[0].at("on"), "floor");
  EXPECT_EQ(pieces[6].at("on"), "wall");
  EXPECT_EQ(pieces[7].at("on"), "wall board");
}

TEST(FurnitureFile, ThatCannotBeWrittenIsNamed) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "none/furniture.json";
  try {
    write_furniture(file, {});
    FAIL() << "written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(file.string()));
  }
}

TEST(FurnitureFile, IsWrittenBesideTheSurface) {
  const test::TemporaryFolder folder;
  SimulatorOptions options;
  options.width_px = 44;
  options.height_px = 36;
  options.frames = 1;
  options.rearranged = 3;
  const Simulator simulator(make_scene("flat"), options);
  simulate_sequence(simulator, folder.path() / "seq");
  std::ifstream in(folder.path() / "seq/furniture.json");
  const nlohmann::json pieces = nlohmann::json::parse(in).at("pieces");
  EXPECT_EQ(pieces.size(), simulator.furniture().size());
  std::set<std::string> states;
  for (const nlohmann::json& piece : pieces) states.insert(piece.at("state"));
  EXPECT_EQ(states, (std::set<std::string>{"gone", "moved", "new", "same"}));
}

}  // namespace
}  // namespace tofmap
