#include "renderer/scene_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/check.h"
#include "core/input_error.h"
#include "core/nearest_name.h"

namespace ensemble {
namespace {

constexpr std::size_t kNamedInMessages = 3;

std::string writeNearest(const std::string& name, std::span<const std::string> known, const char* if_none) {
  return known.empty() ? if_none : "write " + quotedList(nearestNames(name, known, kNamedInMessages));
}

std::vector<std::string> itemNames(const Wardrobe& wardrobe) {
  std::vector<std::string> names;
  for (const Item& item : wardrobe.items) names.push_back(item.name);
  return names;
}

}  // namespace

SceneNames::SceneNames(const Scene& scene, std::span<const Wardrobe> wardrobes)
    : scene_(scene), wardrobes_(wardrobes) {
  ENSEMBLE_CHECK(wardrobes.size() == scene.wardrobes.size());
  ENSEMBLE_CHECK(!wardrobes.empty());
}

void SceneNames::fail(const SourceMark& mark, const std::string& what, const std::string& mend) const {
  throw InputError({scene_.file.string(), mark.toString(), what, mend});
}

std::string SceneNames::describe(std::uint32_t wardrobe) const {
  const SceneWardrobe& named = scene_.wardrobes[wardrobe];
  return "the wardrobe " + quotedName(named.key.empty() ? named.folder.string() : named.key);
}

std::uint32_t SceneNames::wardrobe(const std::string& key, const SourceMark& mark) const {
  std::vector<std::string> keys;
  for (std::uint32_t w = 0; w < scene_.wardrobes.size(); ++w) {
    keys.push_back(scene_.wardrobes[w].key);
    if (keys.back() == key && !key.empty()) return w;
  }
  if (keys.size() == 1 && keys[0].empty()) {
    fail(mark, fmt::format("there is no wardrobe {}: the scene's only one has no key", quotedName(key)),
         "remove the name, or give 'wardrobe: {KEY: FOLDER}'");
  }
  fail(mark, fmt::format("there is no wardrobe {}", quotedName(key)), writeNearest(key, keys, ""));
}

ItemId SceneNames::findItem(std::uint32_t wardrobe, std::string_view name) const {
  const PerItem<Item>& items = wardrobes_[wardrobe].items;
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? ItemId::none() : ItemId(static_cast<std::size_t>(found - items.begin()));
}

std::optional<std::uint32_t> SceneNames::wardrobePrefix(const std::string& name) const {
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos || slash == 0) return std::nullopt;
  for (std::uint32_t w = 0; w < scene_.wardrobes.size(); ++w) {
    if (name.compare(0, slash, scene_.wardrobes[w].key) == 0) return w;
  }
  return std::nullopt;
}

std::vector<std::string> SceneNames::allOutfitNames() const {
  std::map<std::string, int> owners;
  for (const Wardrobe& wardrobe : wardrobes_) {
    for (const Item& item : wardrobe.items) ++owners[item.name];
  }
  std::vector<std::string> names;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    for (const Item& item : wardrobes_[w].items) {
      names.push_back(owners[item.name] > 1 ? scene_.wardrobes[w].key + '/' + item.name : item.name);
    }
  }
  return names;
}

FoundOutfit SceneNames::outfit(const std::string& name, const SourceMark& mark) const {
  std::vector<FoundOutfit> found;
  std::vector<std::string> full_names;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    const ItemId item = findItem(w, name);
    if (!item.valid()) continue;
    found.push_back({w, item});
    full_names.push_back(scene_.wardrobes[w].key + '/' + name);
  }
  if (found.size() == 1) return found[0];
  if (found.size() > 1) {
    fail(mark, fmt::format("{} wardrobes have an outfit {}", found.size(), quotedName(name)),
         "write " + quotedList(full_names));
  }
  if (const auto w = wardrobePrefix(name)) return {*w, outfitOf(*w, name, mark)};
  if (wardrobes_.size() == 1) return {0, outfitOf(0, name, mark)};
  fail(mark, fmt::format("no wardrobe has an outfit {}", quotedName(name)),
       writeNearest(name, allOutfitNames(), "add outfits to the wardrobes"));
}

ItemId SceneNames::outfitOf(std::uint32_t wardrobe, const std::string& name, const SourceMark& mark) const {
  ItemId item = findItem(wardrobe, name);
  std::string bare = name;
  if (!item.valid() && wardrobePrefix(name) == wardrobe) {
    bare = name.substr(name.find('/') + 1);
    item = findItem(wardrobe, bare);
  }
  if (item.valid()) return item;
  const std::vector<std::string> known = itemNames(wardrobes_[wardrobe]);
  fail(mark, fmt::format("{} has no outfit {}", describe(wardrobe), quotedName(bare)),
       writeNearest(bare, known, "add outfits to it"));
}

std::uint32_t SceneNames::clipOf(std::uint32_t wardrobe, const std::string& name,
                                 const SourceMark& mark) const {
  std::vector<std::string> known;
  for (const Clip& clip : wardrobes_[wardrobe].body.clips) {
    if (clip.name == name) return static_cast<std::uint32_t>(known.size());
    known.push_back(clip.name);
  }
  fail(mark, fmt::format("{} has no clip {}", describe(wardrobe), quotedName(name)),
       writeNearest(name, known, "tag it again with 'ensemble tag --clips'"));
}

}  // namespace ensemble
