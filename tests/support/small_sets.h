// Environments in memory: walls and floors of a few faces.
#pragma once

#include <array>
#include <string>

#include "core/environment_mesh.h"

namespace ensemble::testing {

/// Two faces from `corner` along two edges, seen from where along x up points to; u and v along them.
inline RawPrimitive quad(std::uint32_t material, Vec3 corner, Vec3 along, Vec3 up) {
  RawPrimitive primitive;
  primitive.material = material;
  const Vec3 normal = glm::normalize(glm::cross(along, up));
  for (const Vec2 at : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) {
    primitive.vertices.push_back(
        {.position = corner + at.x * along + at.y * up, .normal = normal, .uv = at, .skin = {}});
  }
  primitive.faces = {{0, 1, 2}, {0, 2, 3}};
  return primitive;
}

inline RawMaterial setMaterial(const std::string& name, Vec3 color) {
  RawMaterial material;
  material.name = name;
  material.base_color = Vec4(color, 1.0f);
  return material;
}

/// A set of quads, one material for all.
inline RawAsset setOf(std::vector<RawPrimitive> quads) {
  RawAsset asset;
  asset.materials.push_back(setMaterial("stone", Vec3(0.5f)));
  asset.meshes.push_back(
      {.name = "set", .json_pointer = "/nodes/0", .skinned = false, .primitives = std::move(quads)});
  return asset;
}

/// A wall in the plane z = `z` that looks along +Z.
inline RawPrimitive wallAt(float z, float low_x, float high_x, float height) {
  return quad(0, Vec3(low_x, 0.0f, z), Vec3(high_x - low_x, 0.0f, 0.0f), Vec3(0.0f, height, 0.0f));
}

/// A floor at `y` that looks up.
inline RawPrimitive floorAt(float y, float half) {
  return quad(0, Vec3(-half, y, half), Vec3(2.0f * half, 0.0f, 0.0f), Vec3(0.0f, 0.0f, -2.0f * half));
}

}  // namespace ensemble::testing
