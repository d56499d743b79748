// The vertex that the GPU holds for every mesh of people, body and garment alike, and that of things that
// never move. Compiled by C++ and GLSL.
#ifndef ENSEMBLE_SHADERS_SHARED_VERTEX_H
#define ENSEMBLE_SHADERS_SHARED_VERTEX_H

// Attribute locations of the vertex input.
#define ENSEMBLE_ATTRIBUTE_POSITION 0
#define ENSEMBLE_ATTRIBUTE_NORMAL 1
#define ENSEMBLE_ATTRIBUTE_UV 2
#define ENSEMBLE_ATTRIBUTE_JOINTS 3
#define ENSEMBLE_ATTRIBUTE_WEIGHTS 4

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

namespace ensemble {

/// 40 bytes. Formats: R32G32B32_SFLOAT, R16G16_SNORM (octahedral), R32G32_SFLOAT,
/// R16G16B16A16_UINT, R16G16B16A16_UNORM (the four sum to exactly 65535, or all are 0).
struct GpuVertex {
  float position[3];
  std::int16_t normal_oct[2];
  float uv[2];
  std::uint16_t joints[4];
  std::uint16_t weights[4];
  bool operator==(const GpuVertex&) const = default;
};
static_assert(sizeof(GpuVertex) == 40);
static_assert(offsetof(GpuVertex, normal_oct) == 12 && offsetof(GpuVertex, uv) == 16 &&
              offsetof(GpuVertex, joints) == 24 && offsetof(GpuVertex, weights) == 32);

/// 24 bytes, in the world; formats as GpuVertex's.
struct GpuStaticVertex {
  float position[3];
  std::int16_t normal_oct[2];
  float uv[2];
  bool operator==(const GpuStaticVertex&) const = default;
};
static_assert(sizeof(GpuStaticVertex) == 24);
static_assert(offsetof(GpuStaticVertex, normal_oct) == 12 && offsetof(GpuStaticVertex, uv) == 16);

}  // namespace ensemble
#else
// The unit normal of an octahedral pair in [-1, 1] (Meyer et al. 2010).
vec3 decodeOctahedral(vec2 e) {
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

// The other way, of a vector of any length.
vec2 encodeOctahedral(vec3 n) {
  vec2 e = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20);
  vec2 folded = (1.0 - abs(e.yx)) * vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
  return n.z < 0.0 ? folded : e;
}
#endif
#endif
