// A dressed body in one pose, asked by rays (Embree).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "assetpipe/ray_device.h"
#include "assetpipe/viewed_surface.h"
#include "core/wardrobe.h"

namespace ensemble {

/// What a ray meets of a body.
struct BodyHit {
  std::uint32_t face = 0;
  Vec3 normal{0.0f};  ///< of the face, of length 1
};

/// A surface that is looked at, and what stands around it, in a pose. What an alpha mask may cut out hides
/// nothing; the back of a single-sided material is not there, as in a picture.
class RayScene {
 public:
  /// What stands around the surface.
  struct Around {
    const TemplateBody* body = nullptr;  ///< null: the surface is the body
    std::span<const Item* const> items;  ///< their garments
  };
  /// @param matrices what skins a vertex, #joints (skinningMatrices)
  RayScene(const RayDevice& device, const ViewedSurface& surface, const Around& around,
           std::span<const Mat4> matrices);
  ~RayScene();
  RayScene(RayScene&&) noexcept;

  /// Vertices of the surface in this pose, #V.
  std::span<const Vec3> vertices() const { return vertices_; }

  /// Whether someone far away in a direction sees a point of a face of the surface: nothing stands before it,
  /// be it body, garment or another face of the surface.
  bool isSeen(Vec3 point, Vec3 direction, std::uint32_t face) const;
  /// Whether who looks along the opposite of a direction, through a point of the surface that is not there,
  /// sees the outside of a garment around it at most so far behind it; metres.
  bool hasClothUnder(Vec3 point, Vec3 direction, float most) const;

  /// The first face of a body whose outside one sees; only where that is the surface, and nothing around it.
  std::optional<BodyHit> bodyAt(Vec3 from, Vec3 direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::vector<Vec3> vertices_;
};

}  // namespace ensemble
