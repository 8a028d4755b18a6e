// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <embree3/rtcore.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3f;

/// The point of the triangle a, b, c that is nearest to p: the foot of the perpendicular if it lies
/// inside the triangle, otherwise the nearest point of an edge.
Vector3f nearest_on_triangle(const Vector3f& p, const Vector3f& a, const Vector3f& b,
                             const Vector3f& c) {
  const Vector3f normal = (b - a).cross(c - a);
  const float area = normal.squaredNorm();
  if (area > 0) {
    const float u = (c - b).cross(p - b).dot(normal) / area;
    const float v = (a - c).cross(p - c).dot(normal) / area;
    if (u >= 0 && v >= 0 && u + v <= 1) return u * a + v * b + (1 - u - v) * c;
  }
  const auto on_edge = [&](const Vector3f& from, const Vector3f& to) -> Vector3f {
    const Vector3f edge = to - from;
    const float length = edge.squaredNorm();
    const float share = length > 0 ? std::clamp((p - from).dot(edge) / length, 0.0F, 1.0F) : 0.0F;
    return from + share * edge;
  };
  Vector3f best = on_edge(a, b);
  for (const Vector3f& other : {on_edge(b, c), on_edge(c, a)}) {
    if ((other - p).squaredNorm() < (best - p).squaredNorm()) best = other;
  }
  return best;
}

/// Callback of the point query: reduces the query radius to the distance of one triangle.
bool shrink_to_triangle(RTCPointQueryFunctionArguments* arguments) {
  const auto& mesh = *static_cast<const TriangleMesh*>(arguments->userPtr);
  const auto& triangle = mesh.triangles[arguments->primID];
  RTCPointQuery& query = *arguments->query;
  const Vector3f p(query.x, query.y, query.z);
  const Vector3f nearest = nearest_on_triangle(
      p, mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]);
  const float reach = (nearest - p).norm();
  if (reach >= query.radius) return false;
  query.radius = reach;
  return true;
}

}  // namespace

struct RayScene::Embree {
  TriangleMesh mesh;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  explicit Embree(const TriangleMesh& surface) : mesh(surface) {
    // With one build thread the tree is the same in every run. The tree decides which of two
    // touching triangles a ray through their common edge meets.
    device = rtcNewDevice("threads=1");
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);  // no ray passes between adjacent triangles
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                3 * sizeof(float), mesh.vertices.size()));
    auto* triangles = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                3 * sizeof(std::uint32_t), mesh.triangles.size()));
    for (const Vector3f& vertex : mesh.vertices) {
      vertices = std::copy_n(vertex.data(), 3, vertices);
    }
    for (const auto& triangle : mesh.triangles) {
      triangles = std::copy_n(triangle.data(), 3, triangles);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayScene::RayScene(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw UsageError("a scene needs at least one triangle");
  embree_ = std::make_unique<Embree>(mesh);
}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

std::optional<RayHit> RayScene::cast(const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction, double max_range_m) const {
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(origin.x());
  ray.ray.org_y = static_cast<float>(origin.y());
  ray.ray.org_z = static_cast<float>(origin.z());
  ray.ray.dir_x = static_cast<float>(direction.x());
  ray.ray.dir_y = static_cast<float>(direction.y());
  ray.ray.dir_z = static_cast<float>(direction.z());
  ray.ray.tfar = static_cast<float>(max_range_m);
  ray.ray.mask = ~0U;  // builds of Embree with ray masks find no hit if the mask is 0
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(embree_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;

  const TriangleMesh& mesh = embree_->mesh;
  const auto& triangle = mesh.triangles[ray.hit.primID];
  const double u = ray.hit.u;
  const double v = ray.hit.v;
  RayHit hit;
  hit.range_m = ray.ray.tfar;
  hit.normal = Eigen::Vector3d(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).normalized();
  hit.cos_incidence = std::min(1.0, std::abs(hit.normal.dot(direction)));
  hit.reflectance = (1 - u - v) * mesh.reflectance[triangle[0]] +
                    u * mesh.reflectance[triangle[1]] + v * mesh.reflectance[triangle[2]];
  return hit;
}

double RayScene::clearance_m(const Eigen::Vector3d& point, double limit_m) const {
  RTCPointQuery query{};
  query.x = static_cast<float>(point.x());
  query.y = static_cast<float>(point.y());
  query.z = static_cast<float>(point.z());
  query.radius = static_cast<float>(limit_m);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(embree_->scene, &query, &context, shrink_to_triangle, &embree_->mesh);
  return query.radius;
}

}  // namespace tofmap
