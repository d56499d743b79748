#include "assetpipe/body_surface.h"

#include <embree3/rtcore.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "assetpipe/ray_device.h"
#include "core/check.h"

namespace ensemble {
namespace {

/// The nearest point of a triangle (Ericson, Real-Time Collision Detection, 5.1.5) as shares of its corners.
Vec3 nearestShares(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0f && d2 <= 0.0f) return {1, 0, 0};
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0f && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
    const float t = d1 == d3 ? 0.0f : d1 / (d1 - d3);
    return {1.0f - t, t, 0};
  }
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0f && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
    const float t = d2 == d6 ? 0.0f : d2 / (d2 - d6);
    return {1.0f - t, 0, t};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
    const float sum = (d4 - d3) + (d5 - d6);
    const float t = sum == 0.0f ? 0.0f : (d4 - d3) / sum;
    return {0, 1.0f - t, t};
  }
  const float sum = va + vb + vc;
  if (!(sum > 0.0f)) return {1, 0, 0};
  return {va / sum, vb / sum, vc / sum};
}

constexpr float kOnFeature = 1e-4f;  // share of a corner that counts as none

struct Query {
  const std::vector<Vec3>* positions;
  const std::vector<Triangle>* faces;
  Vec3 from;
  NearestPoint best;
};

bool takeFace(RTCPointQueryFunctionArguments* arguments) {
  auto& query = *static_cast<Query*>(arguments->userPtr);
  const Triangle& face = (*query.faces)[arguments->primID];
  const Vec3 &a = (*query.positions)[face[0]], &b = (*query.positions)[face[1]],
             &c = (*query.positions)[face[2]];
  const Vec3 shares = nearestShares(query.from, a, b, c);
  const Vec3 point = shares.x * a + shares.y * b + shares.z * c;
  const float distance = glm::distance(point, query.from);
  // Of faces at one distance the first counts, whatever the order they are visited in.
  const bool is_nearer = distance < query.best.distance ||
                         (distance == query.best.distance && arguments->primID < query.best.face);
  if (!is_nearer) return false;
  query.best = {arguments->primID, point, shares, distance};
  arguments->query->radius = std::nextafter(distance, std::numeric_limits<float>::max());
  return true;
}

}  // namespace

struct BodySurface::State {
  RayDevice device;
  RTCScene scene = nullptr;
  ~State() {
    if (scene) rtcReleaseScene(scene);
  }
};

BodySurface::BodySurface(std::span<const Vec3> positions, std::span<const Triangle> faces)
    : state_(std::make_unique<State>()) {
  ENSEMBLE_CHECK(!faces.empty());
  weld(positions, faces);
  findNormals();
  findNeighbours();
  buildScene();
}

void BodySurface::weld(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  std::map<std::tuple<float, float, float>, std::uint32_t> known;
  for (Triangle face : faces) {
    for (std::uint32_t& corner : face) {
      const Vec3& p = positions[corner];
      const auto [entry, is_new] =
          known.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(positions_.size()));
      if (is_new) {
        positions_.push_back(p);
        source_.push_back(corner);
      }
      corner = entry->second;
    }
    faces_.push_back(face);
  }
}

void BodySurface::findNormals() {
  normals_.assign(positions_.size(), Vec3(0.0f));
  for (const Triangle& face : faces_) {
    const Vec3 &a = positions_[face[0]], &b = positions_[face[1]], &c = positions_[face[2]];
    const Vec3 area = glm::cross(b - a, c - a);
    const float length = glm::length(area);
    face_normals_.push_back(length > 0.0f ? area / length : Vec3(0.0f));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 to = positions_[face[(k + 1) % 3]] - positions_[face[k]];
      const Vec3 back = positions_[face[(k + 2) % 3]] - positions_[face[k]];
      const float lengths = glm::length(to) * glm::length(back);
      if (!(lengths > 0.0f)) continue;
      const float angle = std::acos(glm::clamp(glm::dot(to, back) / lengths, -1.0f, 1.0f));
      normals_[face[k]] += face_normals_.back() * angle;
    }
  }
  for (Vec3& normal : normals_) normal /= std::max(glm::length(normal), 1e-12f);
}

void BodySurface::findNeighbours() {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> face_of_edge;
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) face_of_edge.try_emplace({faces_[f][k], faces_[f][(k + 1) % 3]}, f);
  }
  across_.resize(faces_.size());
  on_border_.assign(positions_.size(), 0);
  for (std::uint32_t f = 0; f < faces_.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = faces_[f][k], to = faces_[f][(k + 1) % 3];
      const auto other = face_of_edge.find({to, from});
      across_[f][k] = other == face_of_edge.end() ? f : other->second;
      if (across_[f][k] == f) on_border_[from] = on_border_[to] = 1;
    }
  }
}

void BodySurface::buildScene() {
  state_->scene = rtcNewScene(state_->device.get());
  const RTCGeometry geometry = state_->device.newTriangles(positions_, faces_);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(state_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(state_->scene);
}

BodySurface::~BodySurface() = default;

NearestPoint BodySurface::nearest(const Vec3& position) const {
  Query query{&positions_, &faces_, position, {}};
  query.best.distance = std::numeric_limits<float>::max();
  RTCPointQuery point{};
  point.x = position.x, point.y = position.y, point.z = position.z;
  point.radius = std::numeric_limits<float>::infinity();
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(state_->scene, &point, &context, takeFace, &query);
  return query.best;
}

Vec3 BodySurface::edgeNormal(std::uint32_t face, std::size_t corner) const {
  return face_normals_[face] + face_normals_[across_[face][corner]];
}

Vec3 BodySurface::sideNormal(const NearestPoint& nearest) const {
  const Triangle& face = faces_[nearest.face];
  for (int k = 0; k < 3; ++k) {
    if (nearest.shares[k] > 1.0f - kOnFeature) return normals_[face[static_cast<std::size_t>(k)]];
  }
  for (int k = 0; k < 3; ++k) {
    if (nearest.shares[(k + 2) % 3] < kOnFeature)
      return edgeNormal(nearest.face, static_cast<std::size_t>(k));
  }
  return face_normals_[nearest.face];
}

bool BodySurface::isOnBorder(const NearestPoint& nearest) const {
  const Triangle& face = faces_[nearest.face];
  for (std::size_t k = 0; k < 3; ++k) {
    const int corner = static_cast<int>(k);
    if (nearest.shares[corner] > 1.0f - kOnFeature) return on_border_[face[k]] != 0;
    const bool on_edge = nearest.shares[(corner + 2) % 3] < kOnFeature;
    if (on_edge && across_[nearest.face][k] == nearest.face) return true;
  }
  return false;
}

float BodySurface::signedDistance(const Vec3& position) const {
  const NearestPoint found = nearest(position);
  return glm::dot(position - found.point, sideNormal(found)) < 0.0f ? -found.distance : found.distance;
}

Vec3 BodySurface::normalAt(const NearestPoint& nearest) const {
  const Triangle& face = faces_[nearest.face];
  const Vec3 sum = nearest.shares.x * normals_[face[0]] + nearest.shares.y * normals_[face[1]] +
                   nearest.shares.z * normals_[face[2]];
  const float length = glm::length(sum);
  return length > 1e-6f ? sum / length : face_normals_[nearest.face];
}

}  // namespace ensemble
