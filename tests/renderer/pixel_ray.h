// The ray through a pixel against a triangle: what an AOV should say.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/view_setup.h"

namespace ensemble::testing {

/// Where the ray through a pixel's centre meets a triangle's plane: distance along the view axis, and
/// by how much the point lies outside of the triangle (negative weights), in weights.
struct Hit {
  float depth = 0.0f, outside = 0.0f;
  Vec3 normal{0.0f};
};

inline Hit intersect(const View& view, std::uint32_t x, std::uint32_t y, const std::array<Vec3, 3>& corners) {
  const CameraFrame frame = cameraFrame(view.camera);
  const float tan_y = std::tan(view.camera.fov_y / 2);
  const float aspect = static_cast<float>(view.width) / static_cast<float>(view.height);
  const float u =
      (2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(view.width) - 1.0f) * tan_y * aspect;
  const float v = (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(view.height)) * tan_y;
  const Vec3 ray = frame.forward + u * frame.right + v * frame.up;
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
  const Vec3 normal = glm::cross(a, b);
  const float t = glm::dot(corners[0] - view.camera.position, normal) / glm::dot(ray, normal);
  const Vec3 p = view.camera.position + t * ray - corners[0];
  const float area = glm::dot(normal, normal);
  const float w1 = glm::dot(glm::cross(p, b), normal) / area, w2 = glm::dot(glm::cross(a, p), normal) / area;
  return {t, -std::min({w1, w2, 1.0f - w1 - w2}), glm::normalize(normal)};
}

}  // namespace ensemble::testing
