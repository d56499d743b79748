#include "assetpipe/fit_in_motion.h"

#include <algorithm>

#include "assetpipe/fit_over_body.h"

namespace ensemble {
namespace {

constexpr float kMotionClearance = 0.001f;  // metres off the skin, in every pose
constexpr float kOtherPlace = 0.03f;        // metres: what stands out further has come from elsewhere

/// A point of the body and the cloth over it at rest.
struct CoveredPoint {
  std::uint32_t from, to;  // it lies in the middle of two vertices of the body; may be one and the same
  NearestPoint cloth;
};

std::vector<CoveredPoint> findCovered(const BodySurface& cloth, const BodySurface& body) {
  std::vector<CoveredPoint> covered;
  const auto check = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 point = 0.5f * (body.positions()[a] + body.positions()[b]);
    const Vec3 normal = glm::normalize(body.normals()[a] + body.normals()[b] + Vec3(0.0f, 1e-9f, 0.0f));
    if (const auto cover = coverOf(cloth, point, normal); cover && cover->ahead < 0.0f)
      covered.push_back({a, b, cover->at});
  };
  for (std::uint32_t v = 0; v < body.positions().size(); ++v) check(v, v);
  for (const Triangle& face : body.faces()) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (face[k] < face[(k + 1) % 3]) check(face[k], face[(k + 1) % 3]);
    }
  }
  return covered;
}

}  // namespace

bool liftInMotion(FieldMesh& cloth, const std::vector<SkinBinding>& skins, const BodySurface& body,
                  const std::vector<PosedBody>& poses) {
  // Vertices of one position are one in a surface, and cloth has none of those: its numbers stay.
  const BodySurface surface(cloth.positions, cloth.faces);
  const std::vector<CoveredPoint> covered = findCovered(surface, body);
  std::vector<float> lifts(surface.positions().size(), 0.0f);
  for (const PosedBody& pose : poses) {
    const std::vector<Vec3> moved = posedPositions(cloth.positions, skins, pose.skinning_matrices);
    for (const CoveredPoint& point : covered) {
      const Triangle& face = surface.faces()[point.cloth.face];
      const Vec3 &a = moved[surface.source()[face[0]]], &b = moved[surface.source()[face[1]]],
                 &c = moved[surface.source()[face[2]]];
      const Vec3 normal = glm::cross(b - a, c - a);
      const Vec3& shares = point.cloth.shares;
      const Vec3 skin = 0.5f * (pose.positions[point.from] + pose.positions[point.to]);
      const float ahead = glm::dot(skin - (shares.x * a + shares.y * b + shares.z * c), normal) /
                          std::max(glm::length(normal), 1e-12f);
      if (ahead < -kMotionClearance || ahead > kOtherPlace) continue;
      for (int k = 0; k < 3; ++k) {
        float& lift = lifts[face[static_cast<std::size_t>(k)]];
        if (shares[k] > 0.02f) lift = std::max(lift, std::min(ahead + kMotionClearance, kMostLift));
      }
    }
  }
  for (std::size_t v = 0; v < lifts.size(); ++v)
    cloth.positions[surface.source()[v]] += lifts[v] * surface.normals()[v];
  return std::any_of(lifts.begin(), lifts.end(), [](float lift) { return lift > 1e-5f; });
}

}  // namespace ensemble
