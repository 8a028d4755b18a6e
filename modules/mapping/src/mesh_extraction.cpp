// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/mesh_extraction.hpp"

#include "grid_key.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <vector>

#include <vtkCellArray.h>
#include <vtkContour3DLinearGrid.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace tofmap {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

/// How far from a point corners are updated. The corners of a cell that contains surface are up to
/// √3 voxels away from it.
constexpr float reach_voxels = 2;

/// Weighted sums at a corner of the grid that is near points.
struct Corner {
  float distance_sum = 0;
  float weight = 0;
  Vector3f normal_sum = Vector3f::Zero();

  float distance() const { return distance_sum / weight; }
};

/// Offsets of the corners of a cell in the order of VTK_HEXAHEDRON.
const std::array<Vector3i, 8> cell_corners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};

/// Signed distances to the surface at the corners of a grid.
class DistanceGrid {
 public:
  explicit DistanceGrid(double voxel_m) : voxel_m_(static_cast<float>(voxel_m)) {}

  void add(const Vector3f& point_m, const Vector3f& normal) {
    const Vector3f at = point_m / voxel_m_;
    if (is_behind_another(at, normal)) return;
    const float reach_m = reach_voxels * voxel_m_;
    const Vector3i first = (at.array() - reach_voxels).ceil().cast<int>();
    const Vector3i last = (at.array() + reach_voxels).floor().cast<int>();
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int x = first.x(); x <= last.x(); ++x) {
          const Vector3f offset_m = Vector3f(x, y, z) * voxel_m_ - point_m;
          const float near = 1 - offset_m.squaredNorm() / (reach_m * reach_m);
          if (near > 0) add_to({x, y, z}, near * near, normal.dot(offset_m), normal);
        }
      }
    }
  }

  const Corner* find(const Vector3i& place) const {
    const auto found = corners_.find(grid_key(place, voxel_m_));
    return found == corners_.end() ? nullptr : &found->second;
  }

  /// Grid coordinates of all corners, in the order of x, then y, then z.
  std::vector<Vector3i> places() const {
    std::vector<std::int64_t> keys;
    keys.reserve(corners_.size());
    for (const auto& [key, corner] : corners_) keys.push_back(key);
    std::ranges::sort(keys);
    std::vector<Vector3i> places;
    places.reserve(keys.size());
    for (const std::int64_t key : keys) places.push_back(grid_place(key));
    return places;
  }

  float voxel_m() const { return voxel_m_; }

 private:
  /// Whether the cell of a point already has a surface that faces the other way, as the other side
  /// of a thin panel does. `at` is in voxels.
  bool is_behind_another(const Vector3f& at, const Vector3f& normal) const {
    Vector3f sum = Vector3f::Zero();
    const Vector3i cell = at.array().floor().cast<int>();
    for (const Vector3i& offset : cell_corners) {
      if (const Corner* corner = find(cell + offset)) sum += corner->normal_sum;
    }
    return sum.dot(normal) < 0;
  }

  void add_to(const Vector3i& place, float weight, float distance_m, const Vector3f& normal) {
    Corner& corner = corners_[grid_key(place, voxel_m_)];
    if (corner.normal_sum.dot(normal) < 0) return;
    corner.distance_sum += weight * distance_m;
    corner.weight += weight;
    corner.normal_sum += weight * normal;
  }

  float voxel_m_;
  std::unordered_map<std::int64_t, Corner> corners_;
};

/// The cells that contain surface, as a VTK grid with distances and normals.
class SurfaceCells {
 public:
  explicit SurfaceCells(const DistanceGrid& grid) : grid_(grid) {
    distances_->SetName("distance");
    normals_->SetName("normal");
    normals_->SetNumberOfComponents(3);
    for (const Vector3i& place : grid.places()) add_cell(place);
    data_->SetPoints(points_);
    data_->SetCells(VTK_HEXAHEDRON, cells_);
    data_->GetPointData()->SetScalars(distances_);
    data_->GetPointData()->AddArray(normals_);
  }

  vtkUnstructuredGrid* data() { return data_; }
  bool empty() { return cells_->GetNumberOfCells() == 0; }

 private:
  void add_cell(const Vector3i& place) {
    std::array<const Corner*, 8> corners{};
    int inside = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i] = grid_.find(place + cell_corners[i]);
      if (corners[i] == nullptr || !(corners[i]->weight > 0)) return;
      inside += corners[i]->distance() < 0 ? 1 : 0;
    }
    if (inside == 0 || inside == static_cast<int>(corners.size())) return;
    std::array<vtkIdType, 8> ids{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      ids[i] = id_of(place + cell_corners[i], *corners[i]);
    }
    cells_->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  }

  vtkIdType id_of(const Vector3i& place, const Corner& corner) {
    const auto [known, is_new] =
        ids_.try_emplace(grid_key(place, grid_.voxel_m()), points_->GetNumberOfPoints());
    if (is_new) {
      const Vector3f at_m = place.cast<float>() * grid_.voxel_m();
      points_->InsertNextPoint(at_m.x(), at_m.y(), at_m.z());
      distances_->InsertNextValue(corner.distance());
      const Vector3f normal = corner.normal_sum.normalized();
      normals_->InsertNextTuple3(normal.x(), normal.y(), normal.z());
    }
    return known->second;
  }

  const DistanceGrid& grid_;
  std::unordered_map<std::int64_t, vtkIdType> ids_;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> cells_;
  vtkNew<vtkFloatArray> distances_;
  vtkNew<vtkFloatArray> normals_;
  vtkNew<vtkUnstructuredGrid> data_;
};

Vector3f vector_at(vtkDataArray& array, vtkIdType i) {
  double value[3];
  array.GetTuple(i, value);
  return Eigen::Vector3d(value[0], value[1], value[2]).cast<float>();
}

SurfaceMesh mesh_of(vtkPolyData& surface) {
  SurfaceMesh mesh;
  vtkDataArray& normals = *surface.GetPointData()->GetArray("normal");
  for (vtkIdType i = 0; i < surface.GetNumberOfPoints(); ++i) {
    mesh.points_m.push_back(vector_at(*surface.GetPoints()->GetData(), i));
    mesh.normals.push_back(vector_at(normals, i).normalized());
  }
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  vtkCellArray& cells = *surface.GetPolys();
  for (cells.InitTraversal(); cells.GetNextCell(count, ids);) {
    std::array<std::uint32_t, 3> triangle{static_cast<std::uint32_t>(ids[0]),
                                          static_cast<std::uint32_t>(ids[1]),
                                          static_cast<std::uint32_t>(ids[2])};
    const Vector3f& a = mesh.points_m[triangle[0]];
    const Vector3f across = (mesh.points_m[triangle[1]] - a).cross(mesh.points_m[triangle[2]] - a);
    const Vector3f normal =
        mesh.normals[triangle[0]] + mesh.normals[triangle[1]] + mesh.normals[triangle[2]];
    if (across.dot(normal) < 0) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

SurfaceMesh extract_mesh(const MapCloud& map, double voxel_m) {
  DistanceGrid grid(voxel_m);
  for (const MapPoint& point : map) {
    grid.add(point.getVector3fMap(), point.getNormalVector3fMap());
  }
  SurfaceCells cells(grid);
  if (cells.empty()) return {};
  vtkNew<vtkContour3DLinearGrid> contour;
  contour->SetInputData(cells.data());
  contour->SetValue(0, 0);
  contour->MergePointsOn();
  contour->InterpolateAttributesOn();
  contour->SequentialProcessingOn();  // makes the order of vertices reproducible
  contour->Update();
  auto* surface = vtkPolyData::SafeDownCast(contour->GetOutputDataObject(0));
  return mesh_of(*surface);
}

}  // namespace tofmap
