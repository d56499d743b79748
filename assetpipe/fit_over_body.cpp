#include "assetpipe/fit_over_body.h"

#include <algorithm>
#include <limits>

namespace ensemble {
namespace {

constexpr int kRounds = 30;
constexpr float kCoverDepth =
    0.03f;  // metres: cloth further off covers a point no more than the next layer does
constexpr float kMostStep = 0.006f;  // metres a vertex moves in a round
constexpr float kFacesAlike = 0.2f;  // cosine between skin and the cloth over it

class Fitter {
 public:
  /// @param is_closed whether the body has an inside
  Fitter(FieldMesh& cloth, const BodySurface& body, float clearance, bool is_closed)
      : cloth_(cloth), body_(body), clearance_(clearance), is_closed_(is_closed) {
    low_ = Vec3(std::numeric_limits<float>::max());
    high_ = -low_;
    for (const Vec3& p : cloth.positions) {
      low_ = glm::min(low_, p - kCoverDepth);
      high_ = glm::max(high_, p + kCoverDepth);
    }
  }

  /// Whether anything had to move.
  bool round() {
    pushes_.assign(cloth_.positions.size(), Vec3(0.0f));
    if (is_closed_) pushOutOfBody();
    pushOverBody();
    bool moved = false;
    for (std::size_t v = 0; v < pushes_.size(); ++v) {
      const float length = glm::length(pushes_[v]);
      if (length < 1e-6f) continue;
      cloth_.positions[v] += pushes_[v] * std::min(1.0f, kMostStep / length);
      moved = true;
    }
    return moved;
  }

 private:
  void pushOutOfBody() {
    for (std::uint32_t v = 0; v < cloth_.positions.size(); ++v)
      pushOut(cloth_.positions[v], clearance_, {v, v, v});
    for (const Triangle& face : cloth_.faces) {
      const Vec3 &a = cloth_.positions[face[0]], &b = cloth_.positions[face[1]],
                 &c = cloth_.positions[face[2]];
      const float less = 0.5f * clearance_;
      pushOut((a + b + c) / 3.0f, less, face);
      pushOut(0.5f * (a + b), less, {face[0], face[1], face[0]});
      pushOut(0.5f * (b + c), less, {face[1], face[2], face[1]});
      pushOut(0.5f * (c + a), less, {face[2], face[0], face[2]});
    }
  }

  void push(std::uint32_t v, const Vec3& by) {
    if (glm::dot(by, by) > glm::dot(pushes_[v], pushes_[v])) pushes_[v] = by;
  }

  void pushOut(const Vec3& point, float clearance, const Triangle& vertices) {
    const NearestPoint at = body_.nearest(point);
    const Vec3 side = body_.sideNormal(at);
    const float distance = glm::dot(point - at.point, side) < 0.0f ? -at.distance : at.distance;
    if (distance >= clearance) return;
    const Vec3 by = glm::normalize(side) * (clearance - distance + 1e-5f);
    for (const std::uint32_t v : vertices) push(v, by);
  }

  void pushOverBody() {
    const BodySurface surface(cloth_.positions, cloth_.faces);
    const auto check = [&](const Vec3& point, const Vec3& normal) {
      if (glm::any(glm::lessThan(point, low_)) || glm::any(glm::greaterThan(point, high_))) return;
      const auto cover = coverOf(surface, point, normal);
      if (!cover || cover->ahead < -0.4f * clearance_) return;
      const Vec3 by = cover->normal * (cover->ahead + 0.4f * clearance_ + 1e-5f);
      const Triangle& face = cloth_.faces[cover->at.face];
      for (int k = 0; k < 3; ++k) {
        if (cover->at.shares[k] > 0.02f) push(face[static_cast<std::size_t>(k)], by);
      }
    };
    for (std::size_t v = 0; v < body_.positions().size(); ++v)
      check(body_.positions()[v], body_.normals()[v]);
    for (const Triangle& face : body_.faces()) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = face[k], b = face[(k + 1) % 3];
        if (a < b)
          check(0.5f * (body_.positions()[a] + body_.positions()[b]),
                glm::normalize(body_.normals()[a] + body_.normals()[b] + Vec3(0.0f, 1e-9f, 0.0f)));
      }
    }
  }

  FieldMesh& cloth_;
  const BodySurface& body_;
  float clearance_;
  bool is_closed_;
  Vec3 low_{0.0f}, high_{0.0f};
  std::vector<Vec3> pushes_;
};

}  // namespace

std::optional<Cover> coverOf(const BodySurface& cloth, const Vec3& point, const Vec3& normal) {
  const NearestPoint at = cloth.nearest(point);
  if (at.distance > kCoverDepth || cloth.isOnBorder(at)) return std::nullopt;
  const Vec3 cloth_normal = glm::normalize(cloth.sideNormal(at));
  if (glm::dot(cloth_normal, normal) < kFacesAlike) return std::nullopt;
  return Cover{glm::dot(point - at.point, cloth_normal) < 0.0f ? -at.distance : at.distance, at,
               cloth_normal};
}

void fitOverBody(FieldMesh& cloth, const BodySurface& body, float clearance) {
  Fitter fitter(cloth, body, clearance, true);
  for (int round = 0; round < kRounds && fitter.round(); ++round) {
  }
}

void fitOverCloth(FieldMesh& cloth, const BodySurface& under, float clearance) {
  Fitter fitter(cloth, under, clearance, false);
  for (int round = 0; round < kRounds && fitter.round(); ++round) {
  }
}

Pokes countPokes(const FieldMesh& cloth, const BodySurface& body, float tolerance) {
  Pokes pokes;
  for (const Vec3& p : cloth.positions) pokes.cloth_in_body += body.signedDistance(p) < -tolerance ? 1 : 0;
  const BodySurface surface(cloth.positions, cloth.faces);
  for (std::size_t v = 0; v < body.positions().size(); ++v) {
    const auto cover = coverOf(surface, body.positions()[v], body.normals()[v]);
    pokes.body_in_front += cover && cover->ahead > tolerance ? 1 : 0;
  }
  return pokes;
}

}  // namespace ensemble
