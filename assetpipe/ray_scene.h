// A dressed body in one pose, asked by rays (Embree).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assetpipe/ray_device.h"
#include "core/wardrobe.h"

namespace ensemble {

/// What a ray meets of a body.
struct BodyHit {
  std::uint32_t face = 0;
  Vec3 normal{0.0f};  ///< of the face, of length 1
};

/// Body and garments as they stand in a pose. What an alpha mask may cut out hides nothing and is left out;
/// the back of a single-sided material is not there, as in a picture.
class RayScene {
 public:
  /// @param matrices what skins a vertex, #joints (skinningMatrices)
  RayScene(const RayDevice& device, const TemplateBody& body, std::span<const Item* const> items,
           std::span<const Mat4> matrices);
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  /// Vertices of the body in this pose, #V.
  std::span<const Vec3> body() const { return body_; }

  /// Whether someone far away in a direction sees a point of a body face: no garment and no other body face
  /// stands before it.
  bool isSeen(Vec3 point, Vec3 direction, std::uint32_t face) const;
  /// Whether who looks along the opposite of a direction, through a point of the body that is not there,
  /// sees the outside of a garment at most so far behind it; metres.
  bool hasClothUnder(Vec3 point, Vec3 direction, float most) const;

  /// The first body face whose outside one sees; only for a scene without garments.
  std::optional<BodyHit> bodyAt(Vec3 from, Vec3 direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<Vec3> body_;
};

}  // namespace ensemble
