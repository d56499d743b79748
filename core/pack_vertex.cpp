// A vertex in the GPU's format (shaders/shared/vertex.h).
#include <algorithm>
#include <cmath>

#include "core/sub_mesh_lists.h"

namespace ensemble {
namespace {

std::uint16_t toUnorm16(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535.0f));
}

std::int16_t toSnorm16(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

/// Octahedral coordinates of a unit vector (Meyer et al. 2010); shaders/shared/vertex.h decodes.
Vec2 encodeOctahedral(Vec3 normal) {
  const float sum = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
  if (!(sum > 0.0f)) return {0.0f, 0.0f};
  normal /= sum;
  if (normal.z >= 0.0f) return {normal.x, normal.y};
  return {(1.0f - std::abs(normal.y)) * (normal.x >= 0.0f ? 1.0f : -1.0f),
          (1.0f - std::abs(normal.x)) * (normal.y >= 0.0f ? 1.0f : -1.0f)};
}

}  // namespace

GpuVertex packVertex(const RawVertex& vertex) {
  GpuVertex packed{};
  for (int axis = 0; axis < 3; ++axis) packed.position[axis] = vertex.position[axis];
  const Vec2 octahedral = encodeOctahedral(vertex.normal);
  packed.normal_oct[0] = toSnorm16(octahedral.x);
  packed.normal_oct[1] = toSnorm16(octahedral.y);
  packed.uv[0] = vertex.uv.x;
  packed.uv[1] = vertex.uv.y;

  // Round the weights; what is missing to one goes to the largest, which is the first.
  int sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    packed.joints[i] = vertex.skin.joints[i];
    packed.weights[i] = toUnorm16(vertex.skin.weights[i]);
    sum += packed.weights[i];
  }
  if (sum > 0) packed.weights[0] = static_cast<std::uint16_t>(packed.weights[0] + 65535 - sum);
  return packed;
}

}  // namespace ensemble
