// A tiny template and outfits for tests of the tagging: an open tube of three regions on two joints.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble::testing {

inline constexpr int kTubeSegments = 8;
inline constexpr int kRingsPerRegion = 4;
inline constexpr int kFacesPerRegion = kTubeSegments * kRingsPerRegion * 2;  // 64
inline const std::vector<std::string> kTubeRegions = {"legs", "torso", "head"};

inline RawSkeleton tubeSkeleton() {
  RawSkeleton skeleton;
  skeleton.bones = {{"pelvis", -1, {}}, {"spine", 0, {Vec3(0.0f, 0.9f, 0.0f), Quat(1, 0, 0, 0), Vec3(1.0f)}}};
  skeleton.joints.resize(2);
  skeleton.joints[0].bone = 0;
  skeleton.joints[1].bone = 1;
  skeleton.joints[1].joint_from_model[3] = Vec4(0.0f, -0.9f, 0.0f, 1.0f);
  return skeleton;
}

/// A band of a tube about the Y axis, its faces looking outwards.
inline RawPrimitive tubeBand(std::uint32_t material, float radius, float bottom, float top, int rings) {
  RawPrimitive primitive;
  primitive.material = material;
  for (int ring = 0; ring <= rings; ++ring) {
    for (int segment = 0; segment < kTubeSegments; ++segment) {
      const float angle = 2.0f * kPi * static_cast<float>(segment) / kTubeSegments;
      const float height = bottom + (top - bottom) * static_cast<float>(ring) / static_cast<float>(rings);
      RawVertex vertex;
      vertex.normal = Vec3(std::sin(angle), 0.0f, std::cos(angle));
      vertex.position = radius * vertex.normal + Vec3(0.0f, height, 0.0f);
      vertex.uv = Vec2(static_cast<float>(segment) / kTubeSegments, height);
      const float upper = std::min(1.0f, std::max(0.0f, height / 1.8f));
      const bool mostly_upper = upper > 0.5f;
      vertex.skin.joints = {static_cast<std::uint16_t>(mostly_upper),
                            static_cast<std::uint16_t>(!mostly_upper), 0, 0};
      vertex.skin.weights = {mostly_upper ? upper : 1.0f - upper, mostly_upper ? 1.0f - upper : upper, 0.0f,
                             0.0f};
      if (vertex.skin.weights[1] == 0.0f) vertex.skin.joints[1] = 0;
      primitive.vertices.push_back(vertex);
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int segment = 0; segment < kTubeSegments; ++segment) {
      const auto at = [&](int r, int s) {
        return static_cast<std::uint32_t>(r * kTubeSegments + s % kTubeSegments);
      };
      primitive.faces.push_back({at(ring, segment), at(ring, segment + 1), at(ring + 1, segment)});
      primitive.faces.push_back({at(ring, segment + 1), at(ring + 1, segment + 1), at(ring + 1, segment)});
    }
  }
  return primitive;
}

/// The template: node "body", materials legs, torso, head of 64 faces each, a clip "sway".
inline RawAsset tubeTemplate() {
  RawAsset asset;
  asset.skeleton = tubeSkeleton();
  RawMeshNode body{"body", "", true, {}};
  for (std::uint32_t r = 0; r < 3; ++r) {
    RawMaterial& material = asset.materials.emplace_back();
    material.name = kTubeRegions[r];
    material.base_color = Vec4(0.6f, 0.4f - 0.05f * static_cast<float>(r), 0.3f, 1.0f);
    const float bottom = 0.6f * static_cast<float>(r);
    body.primitives.push_back(tubeBand(r, 0.2f, bottom, bottom + 0.6f, kRingsPerRegion));
  }
  asset.meshes.push_back(std::move(body));

  RawChannel sway;
  sway.bone = 1;
  for (int key = 0; key <= 10; ++key) {
    const float angle = 0.2f * std::sin(2.0f * kPi * static_cast<float>(key) / 10.0f);
    sway.times.push_back(static_cast<float>(key) * 0.1f);
    sway.values.push_back(Vec4(0.0f, 0.0f, std::sin(angle / 2), std::cos(angle / 2)));
  }
  asset.clips.push_back({"sway", {sway}});
  return asset;
}

/// An outfit: the template's body with the faces for which `keep(region, face)` holds, and a garment
/// "garment.tunic" of one band around the torso.
inline RawAsset tubeOutfit(const std::function<bool(int region, int face)>& keep,
                           float garment_radius = 0.23f) {
  RawAsset asset = tubeTemplate();
  asset.clips.clear();
  for (int r = 0; r < 3; ++r) {
    RawPrimitive& primitive = asset.meshes[0].primitives[static_cast<std::size_t>(r)];
    std::vector<Triangle> kept;
    for (std::size_t f = 0; f < primitive.faces.size(); ++f) {
      if (keep(r, static_cast<int>(f))) kept.push_back(primitive.faces[f]);
    }
    primitive.faces = std::move(kept);
  }
  std::erase_if(asset.meshes[0].primitives, [](const RawPrimitive& p) { return p.faces.empty(); });
  if (asset.meshes[0].primitives.empty()) asset.meshes.clear();
  RawMaterial& cloth = asset.materials.emplace_back();
  cloth.name = "cloth.tunic";
  cloth.base_color = Vec4(0.2f, 0.3f, 0.6f, 1.0f);
  cloth.double_sided = true;
  asset.meshes.push_back({"garment.tunic", "", true, {tubeBand(3, garment_radius, 0.55f, 1.25f, 5)}});
  return asset;
}

}  // namespace ensemble::testing
