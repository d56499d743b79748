// glTF 2.0, sections 3.8 (textures) and 3.9 (materials); KHR_texture_transform;
// KHR_materials_pbrSpecularGlossiness, whose diffuse colour serves as base colour.
#include "core/gltf_material.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/image_file.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kClampToEdge = 33071;

Mat3 readUvTransform(const JsonRef& transform) {
  Vec2 offset(0.0f), scale(1.0f);
  if (const auto ref = transform.find("offset")) {
    const auto numbers = ref->numbers(2);
    offset = Vec2(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]));
  }
  if (const auto ref = transform.find("scale")) {
    const auto numbers = ref->numbers(2);
    scale = Vec2(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]));
  }
  const auto angle = static_cast<float>(transform.numberOr("rotation", 0.0));
  const float c = std::cos(angle), s = std::sin(angle);
  // Translation * rotation * scale, column by column.
  return Mat3(Vec3(c * scale.x, -s * scale.x, 0.0f), Vec3(s * scale.y, c * scale.y, 0.0f),
              Vec3(offset, 1.0f));
}

void readBaseTexture(const GltfDocument& document, const JsonRef& info, GltfMaterial& result,
                     DroppedList& dropped) {
  const JsonRef texture = document.item("textures", document.index(info.require("index"), "textures"));
  result.image = document.findIndex(texture, "source", "images");
  if (!result.image) {
    dropped.add(
        fmt::format("the texture of material '{}', which is neither PNG nor JPEG", result.material.name));
    return;
  }
  if (const auto sampler_index = document.findIndex(texture, "sampler", "samplers")) {
    const JsonRef sampler = document.item("samplers", *sampler_index);
    result.material.repeat_u = sampler.wholeNumberOr("wrapS", 10497, 0xffff) != kClampToEdge;
    result.material.repeat_v = sampler.wholeNumberOr("wrapT", 10497, 0xffff) != kClampToEdge;
  }
  result.uv_set = static_cast<std::uint32_t>(info.wholeNumberOr("texCoord", 0, 64));
  if (const auto extensions = info.find("extensions")) {
    if (const auto transform = extensions->find("KHR_texture_transform")) {
      result.uv_transform = readUvTransform(*transform);
      result.uv_set = static_cast<std::uint32_t>(transform->wholeNumberOr("texCoord", result.uv_set, 64));
    }
  }
}

void readColor(const GltfDocument& document, const JsonRef& owner, const char* factor, const char* texture,
               GltfMaterial& result, DroppedList& dropped) {
  if (const auto ref = owner.find(factor)) {
    const auto rgba = ref->numbers(4);
    for (int i = 0; i < 4; ++i) {
      const double value = rgba[static_cast<std::size_t>(i)];
      if (value < 0.0 || value > 1.0) ref->fail(fmt::format("{} is not between 0 and 1", value));
      result.material.base_color[i] = static_cast<float>(value);
    }
  }
  if (const auto ref = owner.find(texture)) readBaseTexture(document, *ref, result, dropped);
}

void readAlpha(const JsonRef& json, RawMaterial& material, std::vector<std::string>& warnings) {
  const std::string mode = json.stringOr("alphaMode", "OPAQUE");
  if (mode == "MASK" || mode == "BLEND") {
    material.alpha_mode = AlphaMode::kMask;
  } else if (mode != "OPAQUE") {
    json.require("alphaMode").fail(fmt::format("alphaMode '{}' does not exist", mode));
  }
  if (mode == "BLEND") {
    warnings.push_back(fmt::format("material '{}': BLEND is treated as MASK", material.name));
  }
  if (mode == "MASK") material.alpha_cutoff = static_cast<float>(json.numberOr("alphaCutoff", 0.5));
  if (!(material.alpha_cutoff >= 0.0f)) json.require("alphaCutoff").fail("alphaCutoff is negative");
}

void noteDropped(const JsonRef& json, DroppedList& dropped) {
  if (json.has("normalTexture")) dropped.add("normal maps");
  if (json.has("occlusionTexture")) dropped.add("occlusion maps");
  if (json.has("emissiveTexture")) dropped.add("emissive maps");
  if (const auto pbr = json.find("pbrMetallicRoughness"); pbr && pbr->has("metallicRoughnessTexture")) {
    dropped.add("metallic-roughness maps");
  }
}

GltfMaterial readMaterial(const GltfDocument& document, std::size_t index, DroppedList& dropped,
                          std::vector<std::string>& warnings) {
  const JsonRef json = document.item("materials", index);
  GltfMaterial result;
  result.material.name = json.stringOr("name", "");
  if (result.material.name.empty()) {
    result.material.name = fmt::format("material {}", index);
    result.material.has_name = false;
  }
  const auto extensions = json.find("extensions");
  const auto glossy = extensions ? extensions->find("KHR_materials_pbrSpecularGlossiness") : std::nullopt;
  if (glossy) {
    readColor(document, *glossy, "diffuseFactor", "diffuseTexture", result, dropped);
  } else if (const auto pbr = json.find("pbrMetallicRoughness")) {
    readColor(document, *pbr, "baseColorFactor", "baseColorTexture", result, dropped);
  }
  readAlpha(json, result.material, warnings);
  result.material.double_sided = json.booleanOr("doubleSided", false);
  noteDropped(json, dropped);
  return result;
}

RawImage readImage(const GltfDocument& document, std::uint32_t index) {
  const JsonRef json = document.item("images", index);
  RawImage image;
  image.name = json.stringOr("name", "");
  if (const auto view = document.findIndex(json, "bufferView", "bufferViews")) {
    image.bytes = document.copyView(json, *view);
  } else {
    image.bytes = document.loadUri(json.require("uri"));
  }
  readImageHeader(image.bytes, document.file(), json.pointer(), image);
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (pixels > document.options().max_image_pixels) {
    json.fail(fmt::format("the image of {} x {} pixels is larger than the {} pixels allowed", image.width,
                          image.height, document.options().max_image_pixels),
              "scale the texture down");
  }
  return image;
}

}  // namespace

std::vector<GltfMaterial> readMaterials(const GltfDocument& document, DroppedList& dropped,
                                        std::vector<std::string>& warnings) {
  std::vector<GltfMaterial> materials;
  const std::size_t count = document.count("materials");
  for (std::size_t i = 0; i < count; ++i) materials.push_back(readMaterial(document, i, dropped, warnings));
  GltfMaterial plain;
  plain.material.name = "default";
  plain.material.has_name = false;
  materials.push_back(std::move(plain));
  return materials;
}

void addUsedMaterials(const GltfDocument& document, const std::vector<GltfMaterial>& materials,
                      RawAsset& asset) {
  std::vector<bool> used(materials.size(), false);
  for (const RawMeshNode& mesh : asset.meshes) {
    for (const RawPrimitive& primitive : mesh.primitives) used[primitive.material] = true;
  }
  std::map<std::uint32_t, std::uint32_t> image_numbers;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (used[i] && materials[i].image) image_numbers[*materials[i].image] = 0;
  }
  for (auto& [source, number] : image_numbers) {
    number = static_cast<std::uint32_t>(asset.images.size());
    asset.images.push_back(readImage(document, source));
  }
  std::vector<std::uint32_t> material_numbers(materials.size(), 0);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!used[i]) continue;
    material_numbers[i] = static_cast<std::uint32_t>(asset.materials.size());
    asset.materials.push_back(materials[i].material);
    if (materials[i].image) asset.materials.back().image = image_numbers.at(*materials[i].image);
  }
  for (RawMeshNode& mesh : asset.meshes) {
    for (RawPrimitive& primitive : mesh.primitives) primitive.material = material_numbers[primitive.material];
  }
}

}  // namespace ensemble
