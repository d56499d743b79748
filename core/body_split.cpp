#include "core/body_split.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

namespace ensemble {
namespace {

/// How a part shows in all sets.
struct PartSets {
  std::set<std::string> partial;   ///< distinct
  std::vector<std::uint8_t> core;  ///< per face of the part: shown whenever the part shows
};

PartSets setsOf(const BodyPart& part, std::span<const std::vector<std::uint8_t>> visible_sets) {
  PartSets sets{{}, std::vector<std::uint8_t>(part.face_count, 1)};
  for (const std::vector<std::uint8_t>& visible : visible_sets) {
    const auto first = visible.begin() + part.first_face;
    const std::string shown(first, first + part.face_count);
    const auto faces = std::count(shown.begin(), shown.end(), '\1');
    if (faces == 0) continue;
    for (std::size_t f = 0; f < sets.core.size(); ++f) {
      if (shown[f] == 0) sets.core[f] = 0;
    }
    if (static_cast<std::uint32_t>(faces) < part.face_count) sets.partial.insert(shown);
  }
  return sets;
}

}  // namespace

std::vector<DrawPart> splitBody(const TemplateBody& body, std::vector<std::vector<std::uint32_t>> orders,
                                std::span<const std::vector<std::uint8_t>> visible_sets) {
  std::vector<DrawPart> parts;
  for (std::size_t p = 0; p < body.parts.size(); ++p) {
    const PartSets sets = setsOf(body.parts[p], visible_sets);
    const auto core_faces = std::count(sets.core.begin(), sets.core.end(), std::uint8_t{1});
    if (!isSplit(sets.partial.size(), static_cast<std::size_t>(core_faces))) {
      parts.push_back({p, std::move(orders[p])});
      continue;
    }
    DrawPart core{p, {}}, rest{p, {}};
    for (const std::uint32_t face : orders[p]) {
      (sets.core[face - body.parts[p].first_face] != 0 ? core : rest).faces.push_back(face);
    }
    parts.push_back(std::move(core));
    parts.push_back(std::move(rest));
  }
  return parts;
}

}  // namespace ensemble
