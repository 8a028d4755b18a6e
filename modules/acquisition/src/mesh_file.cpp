// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Mesh files, by VTK.

#include <algorithm>
#include <cmath>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPLYWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkUnsignedCharArray.h>

#include <tofmap/acquisition/triangle_mesh.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr float default_reflectance = 0.5F;

/// VTK reports errors on the terminal by itself; our callers get exceptions instead.
template <class Reader>
vtkSmartPointer<vtkPolyData> read_triangles(const std::filesystem::path& file) {
  const int warnings = vtkObject::GetGlobalWarningDisplay();
  vtkObject::SetGlobalWarningDisplay(0);
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(reader->GetOutputPort());
  triangles->PassLinesOff();
  triangles->PassVertsOff();
  triangles->Update();
  vtkObject::SetGlobalWarningDisplay(warnings);
  return triangles->GetOutput();
}

std::vector<float> vertex_reflectance(vtkPolyData& data, std::size_t count) {
  vtkDataArray* colours = data.GetPointData()->GetScalars();
  if (colours == nullptr || colours->GetNumberOfTuples() != static_cast<vtkIdType>(count)) {
    return std::vector<float>(count, default_reflectance);
  }
  const int channels = std::min(3, colours->GetNumberOfComponents());
  std::vector<float> reflectance(count);
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (int c = 0; c < channels; ++c) {
      sum += colours->GetComponent(static_cast<vtkIdType>(i), c);
    }
    reflectance[i] = static_cast<float>(sum / channels / 255);
  }
  return reflectance;
}

TriangleMesh convert(vtkPolyData& data) {
  TriangleMesh mesh;
  const vtkIdType points = data.GetNumberOfPoints();
  mesh.vertices.reserve(static_cast<std::size_t>(points));
  for (vtkIdType i = 0; i < points; ++i) {
    mesh.vertices.push_back(Eigen::Vector3d(data.GetPoint(i)).cast<float>());
  }
  mesh.reflectance = vertex_reflectance(data, mesh.vertices.size());
  vtkNew<vtkIdList> corners;
  vtkCellArray* cells = data.GetPolys();
  for (cells->InitTraversal(); cells->GetNextCell(corners) != 0;) {
    if (corners->GetNumberOfIds() != 3) continue;
    mesh.triangles.push_back({static_cast<std::uint32_t>(corners->GetId(0)),
                              static_cast<std::uint32_t>(corners->GetId(1)),
                              static_cast<std::uint32_t>(corners->GetId(2))});
  }
  return mesh;
}

void check(const std::filesystem::path& file, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw InputError(file.string() + ": holds no triangle; is it whole, and a mesh?");
  }
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    if (!vertex.allFinite())
      throw InputError(file.string() + ": holds vertices that are no number");
  }
  constexpr double kilometre = 1000;
  if (bounds(mesh).sizes().maxCoeff() > kilometre) {
    throw InputError(file.string() +
                     ": spans over a kilometre; is it in millimetres? Meshes are in metres");
  }
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(file.string() + ": no such file");
  }
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  vtkSmartPointer<vtkPolyData> data;
  if (ending == ".ply") {
    data = read_triangles<vtkPLYReader>(file);
  } else if (ending == ".obj") {
    data = read_triangles<vtkOBJReader>(file);
  } else {
    throw InputError(file.string() + ": neither .ply nor .obj; convert it to one of them");
  }
  TriangleMesh mesh = convert(*data);
  check(file, mesh);
  return mesh;
}

void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetName("colours");
  colours->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->InsertNextPoint(mesh.vertices[i].data());
    const double gray = std::round(255.0 * mesh.reflectance[i]);
    colours->InsertNextTuple3(gray, gray, gray);
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.triangles) {
    cells->InsertNextCell({triangle[0], triangle[1], triangle[2]});
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(cells);
  data->GetPointData()->SetScalars(colours);
  vtkNew<vtkPLYWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputData(data);
  writer->SetArrayName("colours");
  writer->SetFileTypeToBinary();
  const int written = writer->Write();
  // VTK does not notice a full disk: the file then is shorter than its vertices and faces.
  constexpr std::size_t bytes_per_vertex = 15;
  constexpr std::size_t bytes_per_face = 13;
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  const std::size_t expected =
      bytes_per_vertex * mesh.vertices.size() + bytes_per_face * mesh.triangles.size();
  if (written == 0 || missing || bytes < expected) {
    throw InputError(file.string() + ": cannot be written whole; is the disk full?");
  }
}

}  // namespace tofmap
