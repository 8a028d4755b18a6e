// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "renderer.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

namespace tofmap {
namespace {

/// Vertices and their colours as VTK arrays.
struct Vertices {
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> colors;

  Vertices() { colors->SetNumberOfComponents(3); }

  vtkIdType add(const Eigen::Vector3f& point_m, Rgb color) {
    colors->InsertNextTuple3(color.red, color.green, color.blue);
    return points->InsertNextPoint(point_m.x(), point_m.y(), point_m.z());
  }
};

vtkSmartPointer<vtkActor> make_actor(vtkPolyData* data) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  return actor;
}

/// Uses much ambient light, so that colours can be recognised in the shade.
void light_softly(vtkActor& actor) {
  actor.GetProperty()->SetAmbient(0.6);
  actor.GetProperty()->SetDiffuse(0.45);
  actor.GetProperty()->SetSpecular(0);
}

vtkSmartPointer<vtkActor> dots_actor(const PointLayer& layer) {
  Vertices vertices;
  vtkNew<vtkCellArray> cells;
  for (std::size_t i = 0; i < layer.points_m.size(); ++i) {
    const vtkIdType id = vertices.add(layer.points_m[i], layer.colors[i]);
    cells->InsertNextCell(1, &id);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vertices.points);
  data->SetVerts(cells);
  data->GetPointData()->SetScalars(vertices.colors);
  auto actor = make_actor(data);
  actor->GetProperty()->SetPointSize(layer.dot_px);
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkSmartPointer<vtkActor> squares_actor(const PointLayer& layer) {
  Vertices vertices;
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < layer.points_m.size(); ++i) {
    const Eigen::Vector3f& normal = layer.normals[i];
    const Eigen::Vector3f a = normal.unitOrthogonal() * (layer.size_m / 2);
    const Eigen::Vector3f b = normal.cross(a);
    // The front of a face is where its corners are counter-clockwise, so these are, seen from the
    // normal.
    vtkIdType corners[4];
    int corner = 0;
    for (const Eigen::Vector3f& offset : {Eigen::Vector3f(-a - b), Eigen::Vector3f(a - b),
                                          Eigen::Vector3f(a + b), Eigen::Vector3f(b - a)}) {
      corners[corner++] = vertices.add(layer.points_m[i] + offset, layer.colors[i]);
      normals->InsertNextTuple3(normal.x(), normal.y(), normal.z());
    }
    cells->InsertNextCell(4, corners);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vertices.points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(vertices.colors);
  data->GetPointData()->SetNormals(normals);
  auto actor = make_actor(data);
  light_softly(*actor);
  actor->GetProperty()->BackfaceCullingOn();
  return actor;
}

vtkSmartPointer<vtkActor> line_actor(const LineLayer& layer) {
  Vertices vertices;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(layer.points_m.size()));
  for (const Eigen::Vector3f& point : layer.points_m) {
    cells->InsertCellPoint(vertices.add(point, layer.color));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vertices.points);
  data->SetLines(cells);
  data->GetPointData()->SetScalars(vertices.colors);
  auto actor = make_actor(data);
  actor->GetProperty()->SetLineWidth(layer.width_px);
  actor->GetProperty()->LightingOff();
  return actor;
}

vtkSmartPointer<vtkActor> mesh_actor(const MeshLayer& layer) {
  Vertices vertices;
  for (std::size_t i = 0; i < layer.points_m.size(); ++i) {
    vertices.add(layer.points_m[i], layer.colors[i]);
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : layer.triangles) {
    const vtkIdType corners[3] = {triangle[0], triangle[1], triangle[2]};
    cells->InsertNextCell(3, corners);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(vertices.points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(vertices.colors);
  auto actor = make_actor(data);
  actor->GetProperty()->SetInterpolationToFlat();
  light_softly(*actor);
  return actor;
}

}  // namespace

void look_from(vtkRenderer& renderer, const Viewpoint& viewpoint) {
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetPosition(viewpoint.eye_m.data());
  camera->SetFocalPoint(viewpoint.target_m.data());
  camera->SetViewUp(viewpoint.up.data());
  camera->SetViewAngle(viewpoint.vertical_fov_deg);
  camera->SetParallelProjection(viewpoint.parallel_height_m > 0 ? 1 : 0);
  if (viewpoint.parallel_height_m > 0) camera->SetParallelScale(viewpoint.parallel_height_m / 2);
  renderer.ResetCameraClippingRange();
}

void replace_drawing(vtkRenderer& renderer, const Drawing& drawing) {
  renderer.RemoveAllViewProps();
  for (const PointLayer& layer : drawing.points) {
    if (layer.points_m.empty()) continue;
    renderer.AddActor(layer.normals.empty() ? dots_actor(layer) : squares_actor(layer));
  }
  for (const LineLayer& layer : drawing.lines) {
    if (layer.points_m.size() > 1) renderer.AddActor(line_actor(layer));
  }
  for (const MeshLayer& layer : drawing.meshes) {
    if (!layer.triangles.empty()) renderer.AddActor(mesh_actor(layer));
  }
  renderer.ResetCameraClippingRange();
}

vtkSmartPointer<vtkRenderer> make_renderer(const Drawing& drawing, const Viewpoint& viewpoint) {
  auto renderer = vtkSmartPointer<vtkRenderer>::New();
  renderer->SetBackground(1, 1, 1);
  vtkNew<vtkLight> light;
  light->SetLightTypeToHeadlight();
  renderer->AddLight(light);
  replace_drawing(*renderer, drawing);
  look_from(*renderer, viewpoint);
  return renderer;
}

}  // namespace tofmap
