#include "assetpipe/body_motion.h"

#include <algorithm>

#include "core/clip.h"

namespace ensemble {
namespace {

constexpr std::uint32_t kPosesOfClip = 12;

}  // namespace

std::vector<std::vector<Mat4>> matricesInClips(const TemplateBody& body) {
  std::vector<std::vector<Mat4>> poses;
  for (const Clip& clip : body.clips) {
    const std::uint32_t count = std::min(kPosesOfClip, clip.key_count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const float key =
          static_cast<float>(clip.key_count - 1) * static_cast<float>(i) / static_cast<float>(count);
      poses.push_back(skinningMatricesAt(body.skeleton, clip, key));
    }
  }
  return poses;
}

std::vector<PosedBody> poseInClips(const TemplateBody& body, const BodySurface& surface) {
  std::vector<PosedBody> poses;
  for (std::vector<Mat4>& matrices : matricesInClips(body)) {
    PosedBody posed{.skinning_matrices = std::move(matrices), .positions = {}};
    for (const std::uint32_t source : surface.source())
      posed.positions.push_back(skinPosition(body.vertices[VertexId(source)], posed.skinning_matrices));
    poses.push_back(std::move(posed));
  }
  return poses;
}

std::vector<Vec3> posedPositions(std::span<const Vec3> positions, std::span<const SkinBinding> skins,
                                 std::span<const Mat4> skinning_matrices) {
  std::vector<Vec3> posed;
  posed.reserve(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    posed.push_back(skinPosition(positions[v], skins[v], skinning_matrices));
  return posed;
}

float heightOver(const PosedBody& posed, const BodySurface& surface, const NearestPoint& below,
                 const Vec3& point) {
  const Triangle& face = surface.faces()[below.face];
  const Vec3 &a = posed.positions[face[0]], &b = posed.positions[face[1]], &c = posed.positions[face[2]];
  const Vec3 normal = glm::cross(b - a, c - a);
  const float length = glm::length(normal);
  const Vec3 skin = below.shares.x * a + below.shares.y * b + below.shares.z * c;
  return length > 0.0f ? glm::dot(point - skin, normal) / length : glm::distance(point, skin);
}

}  // namespace ensemble
