#include "assetpipe/ground_speed.h"

#include <algorithm>
#include <limits>

namespace ensemble {
namespace {

constexpr float kContactHeight = 0.015f;   // metres above the clip's lowest point: touches the ground
constexpr float kStandingSpeed = 0.05f;    // metres a second

std::vector<Vec3> skinnedPositions(const RawSkeleton& skeleton, const std::vector<RawVertex>& vertices,
                                   std::span<const Transform> local) {
  const std::vector<Mat4> matrices = skinningMatrices(skeleton, local);
  std::vector<Vec3> positions;
  positions.reserve(vertices.size());
  for (const RawVertex& vertex : vertices) positions.push_back(skinPosition(vertex, matrices));
  return positions;
}

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

float groundSpeed(const RawSkeleton& skeleton, const std::vector<RawVertex>& vertices, const Clip& clip) {
  if (clip.key_count < 2 || !(clip.seconds > 0.0f) || vertices.empty()) return 0.0f;
  const float interval_seconds = clip.seconds / static_cast<float>(clip.key_count - 1);
  std::vector<std::vector<Vec3>> poses;
  float ground = std::numeric_limits<float>::max();
  for (std::uint32_t key = 0; key < clip.key_count; ++key) {
    poses.push_back(skinnedPositions(skeleton, vertices, clip.key(key)));
    for (const Vec3& position : poses.back()) ground = std::min(ground, position.y);
  }

  // A vertex near the ground at both ends of an interval was carried by it.
  std::vector<float> along_x, along_z;
  for (std::size_t key = 0; key + 1 < poses.size(); ++key) {
    Vec3 moved(0.0f);
    int touching = 0;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Vec3& before = poses[key][v];
      const Vec3& after = poses[key + 1][v];
      if (std::max(before.y, after.y) > ground + kContactHeight) continue;
      moved += after - before;
      ++touching;
    }
    if (touching == 0) continue;
    along_x.push_back(moved.x / static_cast<float>(touching));
    along_z.push_back(moved.z / static_cast<float>(touching));
  }
  if (along_x.empty()) return 0.0f;
  const float speed = glm::length(Vec2(median(along_x), median(along_z))) / interval_seconds;
  return speed < kStandingSpeed ? 0.0f : speed;
}

}  // namespace ensemble
