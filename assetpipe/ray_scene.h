// A dressed body in one pose, asked by rays. The only user of Embree.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble {

/// Shared by all scenes; made once.
class RayDevice {
 public:
  RayDevice();
  ~RayDevice();
  RayDevice(const RayDevice&) = delete;
  RayDevice& operator=(const RayDevice&) = delete;

 private:
  friend class RayScene;
  struct State;
  std::unique_ptr<State> state_;
};

/// Body and garments as they stand in a pose. What an alpha mask may cut out hides nothing and is left out;
/// the back of a single-sided material is not there, as in a picture.
class RayScene {
 public:
  /// @param matrices what skins a vertex, #joints (skinningMatrices)
  RayScene(const RayDevice& device, const TemplateBody& body, std::span<const Item* const> items,
           std::span<const Mat4> matrices);
  ~RayScene();
  RayScene(const RayScene&) = delete;
  RayScene& operator=(const RayScene&) = delete;

  /// Vertices of the body in this pose, #V.
  std::span<const Vec3> body() const { return body_; }

  /// Whether someone far away in a direction sees a point of a body face: no garment and no other body face
  /// stands before it. @param gone per face of the body: 1 where it is left out; empty: all are there
  bool isSeen(Vec3 point, Vec3 direction, std::uint32_t face, std::span<const std::uint8_t> gone) const;
  /// How far under a point of a body face, against the face's normal, the outside of a garment lies inside
  /// the body; infinity if that is more than `most` metres.
  float depthOfCloth(Vec3 point, Vec3 normal, std::uint32_t face, float most) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<Vec3> body_;
};

}  // namespace ensemble
