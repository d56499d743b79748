// template.glb of a wardrobe: the template body with its regions, skeleton and clips.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "core/input_error.h"
#include "core/wardrobe_files.h"

namespace ensemble {
namespace {

using nlohmann::json;

constexpr const char* kTemplateSchema = "ensemble.template/1";
constexpr const char* kMend = "make the wardrobe again with `ensemble tag`";

/// Ground speeds can't be seen in the channels, so they stand in the extras, by clip name.
json clipExtras(const TemplateBody& body) {
  json clips = json::array();
  for (const Clip& clip : body.clips)
    clips.push_back({{"name", clip.name}, {"ground_speed", clip.ground_speed}});
  return clips;
}

}  // namespace

RawAsset assetFromTemplate(const TemplateBody& body) {
  RawAsset asset;
  asset.materials = body.materials;
  asset.images = body.images;
  asset.skeleton = body.skeleton;
  for (const Clip& clip : body.clips) asset.clips.push_back(toRawClip(body.skeleton, clip));

  RawMeshNode node;
  node.name = "body";
  json parts = json::array();
  for (const BodyPart& part : body.parts) {
    RawPrimitive primitive;
    primitive.material = part.material;
    const auto first_face = body.faces.begin() + part.first_face;
    primitive.faces.assign(first_face, first_face + part.face_count);
    std::uint32_t first_vertex = 0xffffffffu, last_vertex = 0;
    for (const Triangle& face : primitive.faces) {
      for (const std::uint32_t vertex : face) {
        first_vertex = std::min(first_vertex, vertex);
        last_vertex = std::max(last_vertex, vertex);
      }
    }
    for (Triangle& face : primitive.faces) {
      for (std::uint32_t& vertex : face) vertex -= first_vertex;
    }
    primitive.vertices.assign(body.vertices.begin() + first_vertex, body.vertices.begin() + last_vertex + 1);
    if (!body.collapses.empty()) {
      for (std::uint32_t v = first_vertex; v <= last_vertex; ++v) {
        const VertexCollapse& collapse = body.collapses[VertexId(v)];
        primitive.collapses.push_back({collapse.target - first_vertex, collapse.level});
      }
    }
    node.primitives.push_back(std::move(primitive));
    parts.push_back(body.regions[part.region].name);
  }
  asset.meshes.push_back(std::move(node));
  asset.extras_json = json{{"ensemble",
                            {{"schema", kTemplateSchema},
                             {"primitive_regions", std::move(parts)},
                             {"clips", clipExtras(body)}}}}
                          .dump();
  return asset;
}

TemplateBody templateFromAsset(const RawAsset& asset, const std::string& file) {
  const json extras = json::parse(asset.extras_json, nullptr, false);
  const json ensemble = extras.is_object() ? extras.value("ensemble", json()) : json();
  const json regions = ensemble.is_object() ? ensemble.value("primitive_regions", json()) : json();
  if (!ensemble.is_object() || ensemble.value("schema", json()) != kTemplateSchema ||
      asset.meshes.size() != 1 || !regions.is_array() ||
      regions.size() != asset.meshes.front().primitives.size() || regions.empty()) {
    throw InputError({file, "/extras/ensemble", "this is not the template of a wardrobe", kMend});
  }

  TemplateBody body;
  body.materials = asset.materials;
  body.images = asset.images;
  body.skeleton = asset.skeleton;
  for (std::size_t p = 0; p < regions.size(); ++p) {
    const RawPrimitive& primitive = asset.meshes.front().primitives[p];
    if (!regions[p].is_string()) throw InputError({file, "/extras/ensemble", "a region has no name", kMend});
    const std::string name = regions[p];
    if (body.regions.empty() || body.regions.raw().back().name != name) {
      for (const Region& region : body.regions) {
        if (region.name == name)
          throw InputError({file, "/extras/ensemble", "region '" + name + "' is torn", kMend});
      }
      body.regions.push({name, static_cast<std::uint32_t>(body.faces.size()), 0,
                         static_cast<std::uint32_t>(body.vertices.size()), 0});
    }
    const RegionId region_id(body.regions.size() - 1);
    Region& region = body.regions[region_id];
    const auto face_count = static_cast<std::uint32_t>(primitive.faces.size());
    body.parts.push_back(
        {region_id, primitive.material, static_cast<std::uint32_t>(body.faces.size()), face_count});
    const auto vertex_offset = static_cast<std::uint32_t>(body.vertices.size());
    for (const Triangle& face : primitive.faces) {
      body.faces.push({face[0] + vertex_offset, face[1] + vertex_offset, face[2] + vertex_offset});
      body.region_of_face.push(region_id);
    }
    for (const RawVertex& vertex : primitive.vertices) body.vertices.push(vertex);
    for (const VertexCollapse& collapse : primitive.collapses)
      body.collapses.push({collapse.target + vertex_offset, collapse.level});
    region.face_count += face_count;
    region.vertex_count += static_cast<std::uint32_t>(primitive.vertices.size());
  }

  if (!body.collapses.empty() && body.collapses.size() != body.vertices.size())
    throw InputError({file, "/meshes/0", "some primitives have _COLLAPSE and some do not", kMend});

  for (const RawClip& raw : asset.clips) {
    body.clips.push_back(sampleClip(body.skeleton, raw));
    for (const json& clip : ensemble.value("clips", json::array())) {
      if (!clip.is_object() || clip.value("name", json()) != raw.name) continue;
      const json speed = clip.value("ground_speed", json());
      if (speed.is_number()) body.clips.back().ground_speed = speed;
    }
  }
  return body;
}

std::string geometryHash(const TemplateBody& body) {
  Sha256 hash;
  hash.feed("ensemble.geometry/1");
  for (const RawVertex& vertex : body.vertices) hash.feedValue(vertex.position);
  for (const Triangle& face : body.faces) hash.feedValue(face);
  for (const Region& region : body.regions)
    hash.feed(std::string_view(region.name)).feedValue(region.face_count);
  for (const RawJoint& joint : body.skeleton.joints) {
    hash.feed(std::string_view(body.skeleton.bones[joint.bone].name));
  }
  return hash.hex();
}

}  // namespace ensemble
