#include "assetpipe/unmatched_parts.h"

#include <limits>
#include <map>
#include <utility>

namespace ensemble {
namespace {

Vec3 centerOf(std::span<const RawVertex> vertices, const Triangle& corners) {
  Vec3 sum(0.0f);
  for (const std::uint32_t corner : corners) sum += vertices[corner].position;
  return sum / 3.0f;
}

/// The region of the template face whose centre is nearest; few faces ask, so look at all.
RegionId nearestRegion(Vec3 here, const TemplateBody& body) {
  RegionId nearest(0);
  float least = std::numeric_limits<float>::max();
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    const float distance = glm::distance(here, centerOf(body.vertices.raw(), body.faces[FaceId(f)]));
    if (distance < least) {
      least = distance;
      nearest = body.region_of_face[FaceId(f)];
    }
  }
  return nearest;
}

}  // namespace

std::vector<ExtraBodyPart> unmatchedParts(const RawPrimitive& primitive,
                                          std::span<const FaceId> template_face, const TemplateBody& body) {
  std::map<RegionId, RawPrimitive> extra;
  std::map<std::pair<RegionId, std::uint32_t>, std::uint32_t> kept;  // (region, vertex) -> new number
  for (std::size_t f = 0; f < primitive.faces.size(); ++f) {
    if (template_face[f].valid()) continue;
    const Triangle& face = primitive.faces[f];
    const RegionId region = nearestRegion(centerOf(primitive.vertices, face), body);
    RawPrimitive& target = extra[region];
    target.material = primitive.material;
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(target.vertices.size());
      const auto [entry, is_new] = kept.try_emplace({region, face[k]}, next);
      if (is_new) target.vertices.push_back(primitive.vertices[face[k]]);
      corners[k] = entry->second;
    }
    target.faces.push_back(corners);
  }
  std::vector<ExtraBodyPart> parts;
  for (auto& [region, part] : extra) parts.push_back({region, std::move(part)});
  return parts;
}

}  // namespace ensemble
