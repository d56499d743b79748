// Vectors and frames. Metres, seconds, radians; +Y up, right-handed, as in glTF.
//
// A transform names both frames, read right to left: `world_from_model`, `clip_from_world`.
#pragma once

#ifndef GLM_FORCE_DEPTH_ZERO_TO_ONE
#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#endif
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace ensemble {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;  ///< column-major, m[column][row]
using Quat = glm::quat;  ///< (w, x, y, z) in the constructor

inline constexpr float kPi = 3.14159265358979323846f;
constexpr float radians(float degrees) { return degrees * (kPi / 180.0f); }
constexpr float degrees(float radians) { return radians * (180.0f / kPi); }

/// Translation, rotation, scale of a node in its parent's frame, applied in the order S, R, T.
struct Transform {
  Vec3 translation{0.0f};
  Quat rotation{1.0f, 0.0f, 0.0f, 0.0f};
  Vec3 scale{1.0f};
};

/// parent_from_node of a transform.
Mat4 toMatrix(const Transform& transform);

/// Splits an affine matrix; a negative determinant becomes a negative x scale, shear is lost.
Transform toTransform(const Mat4& matrix);

}  // namespace ensemble
