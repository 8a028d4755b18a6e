// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/rearrangement.hpp"

#include "furnishing_space.hpp"
#include "furniture_shapes.hpp"
#include "mesh_parts.hpp"
#include "random_draw.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
constexpr double least_translation_m = 0.3;
constexpr double largest_translation_m = 2.5;
constexpr double least_seen_old = 0.12;  ///< share of points, half of which the piece itself hides
constexpr double least_seen_new = 0.3;   ///< share of points, none of which the piece itself hides

/// A new place of a piece: a rotation about the vertical axis through `centre_m`, then a
/// translation.
struct Move {
  Vector3d centre_m = Vector3d::Zero();
  Vector3d translation_m = Vector3d::Zero();
  double yaw_rad = 0;

  Vector3d operator()(const Vector3d& point_m) const {
    const Eigen::AngleAxisd turn(yaw_rad, Vector3d::UnitZ());
    return centre_m + turn * (point_m - centre_m) + translation_m;
  }
};

void apply(const Move& move, TriangleMesh& mesh, const MeshPart& part) {
  for (std::size_t i = 0; i < part.vertices; ++i) {
    Eigen::Vector3f& vertex = mesh.vertices[part.first_vertex + i];
    vertex = move(vertex.cast<double>()).cast<float>();
  }
}

struct NewPiece {
  std::string name;
  TriangleMesh shape;  ///< its centre is above the origin, on the floor of height 0
};

/// A box, a cupboard or a table, smaller by a factor of `scale`.
NewPiece draw_piece(RandomDraw& draw, double scale) {
  const auto size = [&](double low_m, double high_m) {
    return scale * draw.between(low_m, high_m);
  };
  const int kind = draw.index(3);
  const double reflectance = draw.between(0.15, 0.85);
  if (kind == 0) {
    const Vector3d half{size(0.35, 0.9) / 2, size(0.35, 0.8) / 2, 0};
    const Vector3d up(0, 0, draw.between(0.35, 1.1));
    return {"box", box_shape(-half, half + up, reflectance)};
  }
  if (kind == 1) {
    const Vector3d half{size(0.7, 1.5) / 2, size(0.4, 0.6) / 2, 0};
    const Vector3d up(0, 0, draw.between(1.0, 2.0));
    return {"cupboard", box_shape(-half, half + up, reflectance)};
  }
  const Vector3d half{size(0.9, 1.6) / 2, size(0.7, 0.9) / 2, 0};
  return {"table", table_shape(-half, half + Vector3d(0, 0, 0.75), reflectance)};
}

/// Rearranges the furniture of a scene, one piece after the other. Changes of the surface take
/// effect at the end, so that all pieces are placed with regard to the surface as it was.
class Rearranger {
 public:
  Rearranger(Scene scene, int seed)
      : scene_(std::move(scene)),
        path_(sampled(scene_.path)),
        space_(scene_.surface, path_),
        draw_(seed, 0x6d6f766564ULL) {}

  Scene rearranged(int count) {
    using Step = bool (Rearranger::*)();
    constexpr std::array<Step, 3> steps{&Rearranger::take_away, &Rearranger::put_in,
                                        &Rearranger::move};
    const std::vector<int> order = draw_.order(3);
    for (int i = 0; i < count; ++i) {
      // If one kind of change is impossible, another takes its place.
      const bool is_done = std::ranges::any_of(std::array{0, 1, 2}, [&](int next) {
        const int step = order[static_cast<std::size_t>((i + next) % 3)];
        return (this->*steps[static_cast<std::size_t>(step)])();
      });
      if (!is_done) break;
    }
    return with_changes();
  }

 private:
  /// A piece and all that it carries: their indices.
  std::vector<int> group(int piece) const {
    std::vector<int> members{piece};
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (int other = 0; other < old_pieces(); ++other) {
        if (scene_.furniture[static_cast<std::size_t>(other)].on == members[i]) {
          members.push_back(other);
        }
      }
    }
    return members;
  }

  int old_pieces() const { return static_cast<int>(scene_.furniture.size()); }
  FurniturePiece& piece(int index) { return scene_.furniture[static_cast<std::size_t>(index)]; }
  const FurniturePiece& piece(int index) const {
    return scene_.furniture[static_cast<std::size_t>(index)];
  }

  /// Whether neither the piece, nor what it carries, nor what carries it was changed.
  bool is_untouched(const std::vector<int>& members) const {
    const auto is_same = [&](int index) { return piece(index).state == PieceState::same; };
    const int on = piece(members.front()).on;
    return std::ranges::all_of(members, is_same) && (on < 0 || is_same(on));
  }

  /// Some points of the triangles of pieces.
  std::vector<Vector3d> points_of(const std::vector<int>& members) const {
    std::vector<Vector3d> points_m;
    for (const int index : members) {
      for (const Vector3d& point_m : sample_points(scene_.surface, piece(index).part)) {
        points_m.push_back(point_m);
      }
    }
    return points_m;
  }

  bool take_away() {
    for (const int index : draw_.order(old_pieces())) {
      const std::vector<int> members = group(index);
      if (!is_untouched(members) || space_.seen_share(points_of(members)) < least_seen_old) {
        continue;
      }
      for (const int member : members) piece(member).state = PieceState::gone;
      return true;
    }
    return false;
  }

  bool move() {
    for (const int index : draw_.order(old_pieces())) {
      const std::vector<int> members = group(index);
      if (piece(index).on != FurniturePiece::on_floor || !is_untouched(members) ||
          space_.seen_share(points_of(members)) < least_seen_old) {
        continue;
      }
      const auto move = find_move(members);
      if (!move) continue;
      for (const int member : members) {
        FurniturePiece& moved = piece(member);
        moved.state = PieceState::moved;
        moved.translation_m = move->translation_m;
        moved.yaw_rad = move->yaw_rad;
        moves_.emplace_back(member, *move);
      }
      return true;
    }
    return false;
  }

  std::optional<Move> find_move(const std::vector<int>& members) {
    constexpr int attempts = 300;
    Eigen::AlignedBox3d box;
    std::vector<MeshPart> parts;
    for (const int member : members) {
      box.extend(piece(member).box);
      parts.push_back(piece(member).part);
    }
    const TriangleMesh others = without_parts(scene_.surface, parts);
    if (others.triangles.empty()) return std::nullopt;
    const FurnishingSpace space(others, path_);
    const std::vector<Vector3d> points_m = points_of(members);
    for (int i = 0; i < attempts; ++i) {
      const double direction_rad = draw_.between(0, 2 * pi);
      Move move{box.center(),
                draw_.between(least_translation_m, largest_translation_m) *
                    Vector3d(std::cos(direction_rad), std::sin(direction_rad), 0),
                draw_yaw()};
      const UprightBox place{move(box.center()), box.sizes() / 2, move.yaw_rad};
      if (fits(space, place, box.min().z(), points_m, move)) {
        placed_.push_back(place);
        return move;
      }
    }
    return std::nullopt;
  }

  /// No rotation, a quarter turn to either side, or any.
  double draw_yaw() {
    const int kind = draw_.index(4);
    const double any_rad = draw_.between(-pi, pi);
    constexpr std::array<double, 3> turns{0, pi / 2, -pi / 2};
    return kind < 3 ? turns[static_cast<std::size_t>(kind)] : any_rad;
  }

  /// Whether a piece that stands at the height `bottom_m` can be at a place.
  bool fits(const FurnishingSpace& space, const UprightBox& place, double bottom_m,
            const std::vector<Vector3d>& points_m, const Move& move) const {
    constexpr double tolerance_m = 0.01;
    if (!space.is_clear_of_path(place)) return false;
    const auto floor_m = space.floor_beneath_m(place);
    if (!floor_m || std::abs(*floor_m - bottom_m) > tolerance_m) return false;
    if (!is_apart_from_placed(place) || !space.is_free(place)) return false;
    std::vector<Vector3d> moved_m;
    for (const Vector3d& point_m : points_m) moved_m.push_back(move(point_m));
    return space.seen_share(moved_m) >= least_seen_new;
  }

  bool is_apart_from_placed(UprightBox place) const {
    constexpr double gap_m = 0.05;
    place.half_m.array() += gap_m;
    return std::ranges::none_of(placed_,
                                [&](const UprightBox& other) { return intersects(place, other); });
  }

  bool put_in() {
    constexpr int attempts = 600;
    constexpr double most_shrunk = 0.5;
    if (!space_.floor_m()) return false;
    for (int i = 0; i < attempts; ++i) {
      NewPiece wanted = draw_piece(draw_, 1 - most_shrunk * i / attempts);
      const Eigen::AlignedBox3d box = bounds(wanted.shape);
      Move move{Vector3d::Zero(), draw_place(), draw_yaw()};
      UprightBox place{move(box.center()), box.sizes() / 2, move.yaw_rad};
      const auto floor_m = space_.floor_beneath_m(place);
      if (!floor_m) continue;
      move.translation_m.z() = *floor_m;
      place.centre_m.z() = *floor_m + box.center().z();
      const MeshPart whole{0, wanted.shape.vertices.size(), 0, wanted.shape.triangles.size()};
      if (!fits(space_, place, *floor_m, sample_points(wanted.shape, whole), move)) continue;
      apply(move, wanted.shape, whole);
      placed_.push_back(place);
      added_.push_back(std::move(wanted));
      return true;
    }
    return false;
  }

  /// A place ahead of the camera.
  Vector3d draw_place() {
    constexpr double half_angle_rad = 0.55;
    const int count = static_cast<int>(path_.views.size());
    const Pose& view = path_.views[static_cast<std::size_t>(draw_.index(count))];
    const Vector3d ahead = view.linear().col(2);
    const double angle_rad =
        std::atan2(ahead.y(), ahead.x()) + draw_.between(-half_angle_rad, half_angle_rad);
    const double range_m = draw_.between(0.7, 10);
    const Vector3d place_m =
        view.translation() + range_m * Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0);
    return {place_m.x(), place_m.y(), 0};
  }

  Scene with_changes() {
    Scene scene = scene_;
    for (const auto& [index, move] : moves_) {
      FurniturePiece& moved = scene.furniture[static_cast<std::size_t>(index)];
      apply(move, scene.surface, moved.part);
      moved.box = bounds(scene.surface, moved.part);
    }
    remove_gone(scene);
    for (const NewPiece& added : added_) {
      const int index = add_piece(scene, added.name, added.shape);
      FurniturePiece& piece = scene.furniture[static_cast<std::size_t>(index)];
      piece.state = PieceState::added;
      piece.box_before = {};
    }
    return scene;
  }

  Scene scene_;  ///< its surface stays as it was
  SampledPath path_;
  FurnishingSpace space_;
  RandomDraw draw_;
  std::vector<std::pair<int, Move>> moves_;  ///< of pieces
  std::vector<NewPiece> added_;              ///< at their places
  std::vector<UprightBox> placed_;           ///< places of moved and new pieces
};

}  // namespace

Scene rearranged(Scene scene, int count, int seed) {
  if (count <= 0 || scene.path.empty()) return scene;
  return Rearranger(std::move(scene), seed).rearranged(count);
}

}  // namespace tofmap
