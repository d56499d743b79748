// A wardrobe in memory: a tube person of three regions on two joints, with outfits that try what
// the renderer can do: hidden faces that show through openings, textures, cut-outs, loose vertices.
#pragma once

#include <algorithm>
#include <array>

#include "core/clip.h"
#include "core/image_file.h"
#include "core/scene.h"
#include "core/wardrobe.h"
#include "tests/support/small_people.h"

namespace ensemble::testing {

inline constexpr std::uint32_t kTubeFaces = 3 * kFacesPerRegion;

/// A PNG of 16 x 16 texels: squares of two colours of which the second has alpha 0.
inline RawImage checkerImage(std::array<std::uint8_t, 4> first, std::array<std::uint8_t, 4> second) {
  Image8 image{16, 16, std::vector<std::uint8_t>(16 * 16 * 4)};
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      const auto& color = ((x / 4 + y / 4) & 1u) == 0 ? first : second;
      std::copy(color.begin(), color.end(), image.rgba.begin() + 4 * (y * 16 + x));
    }
  }
  return {"checker", "image/png", encodePng(image), 16, 16};
}

inline TemplateBody tubeBody() {
  const RawAsset asset = tubeTemplate();
  TemplateBody body;
  body.skeleton = asset.skeleton;
  body.materials = asset.materials;
  for (const RawClip& clip : asset.clips) body.clips.push_back(sampleClip(asset.skeleton, clip));
  for (std::uint32_t r = 0; r < 3; ++r) {
    const RawPrimitive& primitive = asset.meshes[0].primitives[r];
    const auto first_vertex = static_cast<std::uint32_t>(body.vertices.size());
    const auto first_face = static_cast<std::uint32_t>(body.faces.size());
    for (const RawVertex& vertex : primitive.vertices) body.vertices.push(vertex);
    for (const Triangle& face : primitive.faces) {
      body.faces.push({face[0] + first_vertex, face[1] + first_vertex, face[2] + first_vertex});
      body.region_of_face.push(RegionId(r));
    }
    const auto face_count = static_cast<std::uint32_t>(primitive.faces.size());
    body.regions.push({kTubeRegions[r], first_face, face_count, first_vertex,
                       static_cast<std::uint32_t>(primitive.vertices.size())});
    body.parts.push_back({RegionId(r), r, first_face, face_count});
  }
  return body;
}

/// An item whose body shows the faces for which `keep(region, face)` holds.
template <class Keep>
Item tubeItem(const std::string& name, const TemplateBody& body, const Keep& keep) {
  Item item;
  item.name = name;
  item.visible.assign(kTubeFaces, 0);
  for (const Region& region : body.regions) {
    RegionTag tag;
    for (std::uint32_t f = 0; f < region.face_count; ++f) {
      const auto r = static_cast<int>(region.first_face / kFacesPerRegion);
      const bool is_visible = keep(r, static_cast<int>(f));
      item.visible[FaceId(region.first_face + f)] = is_visible ? 1 : 0;
      tag.visible_faces += is_visible ? 1 : 0;
    }
    tag.visibility = tag.visible_faces == 0                   ? Visibility::kHidden
                     : tag.visible_faces == region.face_count ? Visibility::kFull
                                                              : Visibility::kPartial;
    item.tags.push(tag);
  }
  return item;
}

inline void addBand(Item& item, const std::string& garment, RawMaterial material, float radius, float bottom,
                    float top) {
  const auto number = static_cast<std::uint32_t>(item.materials.size());
  item.materials.push_back(std::move(material));
  item.garments.push_back({garment, {tubeBand(number, radius, bottom, top, 5)}});
}

inline RawMaterial clothMaterial(const std::string& name) {
  RawMaterial material;
  material.name = name;
  material.base_color = Vec4(0.2f, 0.3f, 0.6f, 1.0f);
  material.double_sided = true;
  return material;
}

/// Outfits: "tunic" (hides the torso, some of legs and head; wider than the body, so that naive shows
/// hidden faces above and below), "net" (cut out by a texture), "patch" (a textured band, a hat that no
/// joint moves, and body faces that the template lacks).
inline Wardrobe tubeWardrobe() {
  Wardrobe wardrobe;
  wardrobe.folder = "memory";
  wardrobe.template_file = "template.glb";
  wardrobe.body = tubeBody();
  const TemplateBody& body = wardrobe.body;

  Item tunic = tubeItem("tunic", body, [](int region, int face) {
    return region == 0 ? face < 44 : region == 2 ? face >= 8 : false;
  });
  addBand(tunic, "garment.tunic", clothMaterial("cloth.tunic"), 0.26f, 0.62f, 1.15f);

  Item net = tubeItem("net", body, [](int region, int face) { return region != 1 || face % 3 != 0; });
  RawMaterial net_material = clothMaterial("cloth.net");
  net_material.image = 0;
  net_material.alpha_mode = AlphaMode::kMask;
  net.images.push_back(checkerImage({200, 60, 60, 255}, {200, 60, 60, 0}));
  addBand(net, "garment.net", net_material, 0.3f, 0.5f, 1.3f);

  Item patch = tubeItem("patch", body, [](int region, int) { return region != 0; });
  RawMaterial patch_material = clothMaterial("cloth.patch");
  patch_material.image = 0;
  patch_material.repeat_u = false;
  patch_material.double_sided = false;
  patch.images.push_back(checkerImage({40, 120, 200, 255}, {230, 220, 180, 255}));
  addBand(patch, "garment.patch", patch_material, 0.24f, 0.05f, 0.58f);
  RawMaterial hat = clothMaterial("hair.hat");
  addBand(patch, "garment.hat", hat, 0.22f, 1.7f, 1.95f);
  for (RawVertex& vertex : patch.garments.back().parts[0].vertices) vertex.skin = {};
  RawPrimitive feet = tubeBand(0, 0.21f, 0.0f, 0.05f, 1);
  feet.material = static_cast<std::uint32_t>(patch.materials.size());
  patch.materials.push_back(body.materials[0]);
  patch.extra_body.push_back({RegionId(std::size_t{0}), feet});

  for (Item* item : {&tunic, &net, &patch}) {
    wardrobe.item_files.push("outfits/" + item->name + ".glb");
    wardrobe.items.push(std::move(*item));
  }
  return wardrobe;
}

/// A scene of `count` people of tubeWardrobe(), close together, in a small picture.
inline Scene tubeScene(std::uint32_t count) {
  Scene scene;
  scene.file = "scene.yaml";
  scene.wardrobes.push_back({"", "memory", {}});
  scene.output.width = 160;
  scene.output.height = 120;
  scene.output.samples = 1;
  scene.crowd.count = count;
  scene.crowd.seed = 11;
  scene.crowd.placement.spacing = 0.9f;
  scene.camera.position = Vec3(0.4f, 1.8f, 5.0f);
  scene.camera.target = Vec3(0.0f, 0.9f, 0.0f);
  return scene;
}

}  // namespace ensemble::testing
