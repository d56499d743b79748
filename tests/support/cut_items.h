// A wardrobe of single items, cut out of one of complete outfits: what `wear` combines.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/wardrobe.h"

namespace ensemble::testing {

/// Number of each vertex's connected component, over equal positions.
inline std::vector<std::uint32_t> componentsOf(const ItemPart& part) {
  std::vector<std::uint32_t> parents(part.vertices.size());
  for (std::uint32_t v = 0; v < parents.size(); ++v) parents[v] = v;
  const auto find = [&](std::uint32_t v) {
    while (parents[v] != v) v = parents[v] = parents[parents[v]];
    return v;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) { parents[find(a)] = find(b); };
  std::map<std::array<float, 3>, std::uint32_t> first_at;
  for (std::uint32_t v = 0; v < parents.size(); ++v) {
    const Vec3 p = part.vertices[v].position;
    join(v, first_at.try_emplace({p.x, p.y, p.z}, v).first->second);
  }
  for (const Triangle& face : part.faces) {
    join(face[0], face[1]);
    join(face[0], face[2]);
  }
  for (std::uint32_t v = 0; v < parents.size(); ++v) parents[v] = find(v);
  return parents;
}

/// A part's faces of connected pieces whose middle is above a height, or those of the others.
inline ItemPart piecesOf(const ItemPart& part, float height, bool above) {
  const std::vector<std::uint32_t> components = componentsOf(part);
  std::map<std::uint32_t, std::pair<float, float>> span;
  for (std::uint32_t v = 0; v < components.size(); ++v) {
    const float y = part.vertices[v].position.y;
    const auto [entry, is_new] = span.try_emplace(components[v], y, y);
    entry->second = {std::min(entry->second.first, y), std::max(entry->second.second, y)};
  }
  ItemPart pieces = part;
  std::erase_if(pieces.faces, [&](const Triangle& face) {
    const auto [low, high] = span.at(components[face[0]]);
    return (0.5f * (low + high) > height) != above;
  });
  return pieces;
}

inline Garment halfOf(const Garment& garment, float height, bool above) {
  Garment half{garment.name, {}};
  for (const ItemPart& part : garment.parts) {
    ItemPart pieces = piecesOf(part, height, above);
    if (!pieces.faces.empty()) half.parts.push_back(std::move(pieces));
  }
  return half;
}

inline bool hasWord(const std::string& name, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return name.find(word) != std::string::npos; });
}

/// The items of an outfit, without hidden faces. What is neither hair nor hat nor shoes is cut at the hips
/// into upper and lower where it is of several pieces.
inline std::vector<Item> cutOutfit(const Item& outfit, float hip_height) {
  std::vector<Item> items;
  const auto add = [&](const std::string& name, Slot slot, Garment garment) {
    Item& item = items.emplace_back();
    item.name = name;
    item.slot = slot;
    item.garments.push_back(std::move(garment));
    item.materials = outfit.materials;
    item.images = outfit.images;
  };
  for (const Garment& garment : outfit.garments) {
    const std::string name = garment.name.substr(garment.name.find('.') + 1);
    if (hasWord(name, {"hair", "bob"})) {
      add(name, Slot::kHair, garment);
    } else if (hasWord(name, {"fedora", "hat", "cap"})) {
      add(name, Slot::kHead, garment);
    } else if (hasWord(name, {"shoe", "boot", "sandal", "sneaker"})) {
      add(name, Slot::kFeet, garment);
    } else {
      Garment upper = halfOf(garment, hip_height, true), lower = halfOf(garment, hip_height, false);
      if (upper.parts.empty() || lower.parts.empty()) {
        add(name, Slot::kFull, garment);
        continue;
      }
      add(name + "_top", Slot::kUpper, std::move(upper));
      add(name + "_bottom", Slot::kLower, std::move(lower));
    }
  }
  return items;
}

/// Gives each face that the outfit hides to the item that is nearest to it.
inline void shareHiddenFaces(const Item& outfit, const TemplateBody& body, std::vector<Item>& items) {
  for (Item& item : items) item.visible.assign(body.faces.size(), 1);
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    if (outfit.visible[FaceId(f)] != 0) continue;
    Vec3 centre(0.0f);
    for (const std::uint32_t v : body.faces[FaceId(f)]) centre += body.vertices[VertexId(v)].position / 3.0f;
    float least = std::numeric_limits<float>::max();
    Item* nearest = nullptr;
    for (Item& item : items) {
      for (const ItemPart& part : item.garments[0].parts) {
        for (const Triangle& face : part.faces) {
          const Vec3 offset = part.vertices[face[0]].position - centre;
          if (glm::dot(offset, offset) >= least) continue;
          least = glm::dot(offset, offset);
          nearest = &item;
        }
      }
    }
    if (nearest != nullptr) nearest->visible[FaceId(f)] = 0;
  }
}

/// Another item of the slot `over`: an upper one, blown up.
inline Item jacketOver(const Item& upper) {
  Item jacket = upper;
  jacket.name = upper.name + "_jacket";
  jacket.slot = Slot::kOver;
  jacket.layer = 1;
  jacket.garments[0].name += "_jacket";
  for (ItemPart& part : jacket.garments[0].parts) {
    for (RawVertex& vertex : part.vertices) vertex.position += 0.012f * vertex.normal;
  }
  return jacket;
}

/// All items of the outfits of a wardrobe, each name once, and two jackets. Without tags.
inline Wardrobe cutItems(const Wardrobe& outfits) {
  Wardrobe wardrobe;
  wardrobe.folder = outfits.folder;
  wardrobe.template_file = outfits.template_file;
  wardrobe.body = outfits.body;
  float height = 0.0f;
  for (const RawVertex& vertex : outfits.body.vertices) height = std::max(height, vertex.position.y);
  const auto add = [&](Item item) {
    for (const Item& other : wardrobe.items) {
      if (other.name == item.name) return;
    }
    wardrobe.item_files.push("outfits/" + item.name + ".glb");
    wardrobe.items.push(std::move(item));
  };
  for (const Item& outfit : outfits.items) {
    std::vector<Item> items = cutOutfit(outfit, 0.53f * height);
    shareHiddenFaces(outfit, outfits.body, items);
    for (Item& item : items) add(std::move(item));
  }
  std::vector<Item> jackets;
  for (const Item& item : wardrobe.items) {
    if (item.slot == Slot::kUpper && jackets.size() < 2) jackets.push_back(jacketOver(item));
  }
  for (Item& jacket : jackets) add(std::move(jacket));
  return wardrobe;
}

}  // namespace ensemble::testing
