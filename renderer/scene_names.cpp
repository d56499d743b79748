#include "renderer/scene_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "core/input_error.h"
#include "core/nearest_name.h"

namespace ensemble {
namespace {

constexpr std::size_t kNamedInMessages = 3;
constexpr std::size_t kFewNames = 6;

/// "write 'a' or 'b'": the nearest names where they are near, else all if they are few.
std::string writeNearest(const std::string& name, std::span<const std::string> known, const char* if_none) {
  if (known.empty()) return if_none;
  const std::vector<std::string> nearest = nearestNames(name, known, kNamedInMessages);
  const bool is_near = 2 * editDistance(name, nearest.front()) <= name.size();
  return "write " + (is_near || known.size() > kFewNames ? quotedList(nearest) : quotedList(known));
}

std::vector<std::string> itemNames(const Wardrobe& wardrobe) {
  std::vector<std::string> names;
  for (const Item& item : wardrobe.items) names.push_back(item.name);
  return names;
}

}  // namespace

std::string outfitName(const Wardrobe& wardrobe, const Combination& items) {
  std::string name;
  for (const ItemId item : items) name += (name.empty() ? "" : "+") + wardrobe.items[item].name;
  return name;
}

SceneNames::SceneNames(const Scene& scene, std::span<const Wardrobe> wardrobes, std::filesystem::path file)
    : scene_(scene), wardrobes_(wardrobes), file_(file.empty() ? scene.file : std::move(file)) {
  ENSEMBLE_CHECK(wardrobes.size() == scene.wardrobes.size());
  ENSEMBLE_CHECK(!wardrobes.empty());
}

void SceneNames::fail(const SourceMark& mark, const std::string& what, const std::string& mend) const {
  throw InputError({file_.string(), mark.toString(), what, mend});
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

std::uint32_t SceneNames::wardrobeOrOnly(const Marked<std::string>& key, const std::string& who,
                                         const char* how) const {
  if (!key.value.empty()) return wardrobe(key.value, key.mark);
  if (wardrobes_.size() == 1) return 0;
  std::vector<std::string> keys;
  for (const SceneWardrobe& named : scene_.wardrobes) keys.push_back(named.key);
  fail(key.mark, fmt::format("{} names none of {} wardrobes", who, keys.size()),
       fmt::format("{} {}", how, quotedList(keys)));
}

ItemId SceneNames::findItem(std::uint32_t wardrobe, std::string_view name) const {
  const PerItem<Item>& items = wardrobes_[wardrobe].items;
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
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

std::string SceneNames::writeNearestOutfit(const std::string& name) const {
  std::vector<std::string> known;
  for (const Wardrobe& wardrobe : wardrobes_) {
    for (const Item& item : wardrobe.items) {
      if (std::find(known.begin(), known.end(), item.name) == known.end()) known.push_back(item.name);
    }
  }
  if (known.empty()) return "add outfits to the wardrobes";
  std::vector<std::string> full_names;
  for (const std::string& near : nearestNames(name, known, kNamedInMessages)) {
    const std::vector<std::string> owned = fullNames(near);
    if (owned.size() == 1) {
      full_names.push_back(near);
    } else {
      full_names.insert(full_names.end(), owned.begin(), owned.end());
    }
  }
  return "write " + quotedList(full_names);
}

std::vector<std::string> SceneNames::fullNames(const std::string& bare) const {
  std::vector<std::string> names;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    if (findItem(w, bare).valid()) names.push_back(scene_.wardrobes[w].key + '/' + bare);
  }
  return names;
}

FoundOutfit SceneNames::outfit(const std::string& name, const SourceMark& mark) const {
  std::vector<FoundOutfit> found;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    const ItemId item = findItem(w, name);
    if (item.valid()) found.push_back({w, item});
  }
  if (found.size() == 1) return found[0];
  if (found.size() > 1) {
    fail(mark, fmt::format("{} wardrobes have an outfit {}", found.size(), quotedName(name)),
         "write " + quotedList(fullNames(name)));
  }
  if (const auto w = wardrobePrefix(name)) return {*w, outfitOf(*w, name, mark)};
  if (wardrobes_.size() == 1) return {0, outfitOf(0, name, mark)};
  fail(mark, fmt::format("no wardrobe has an outfit {}", quotedName(name)), writeNearestOutfit(name));
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

Combination SceneNames::combinationOf(std::uint32_t wardrobe, const std::string& name,
                                      const SourceMark& mark) const {
  if (name.empty()) return {};
  if (name.find('+') == std::string::npos || findItem(wardrobe, name).valid()) {
    return {outfitOf(wardrobe, name, mark)};
  }
  const PerItem<Item>& items = wardrobes_[wardrobe].items;
  Combination combination;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('+', begin), name.size());
    const ItemId item = outfitOf(wardrobe, name.substr(begin, end - begin), mark);
    for (const ItemId other : combination) {
      if (items[other].slot != items[item].slot) continue;
      fail(mark,
           fmt::format("{} and {} are both of the slot {}", quotedName(items[other].name),
                       quotedName(items[item].name), quotedName(items[item].slot)),
           "write one of them");
    }
    combination.push_back(item);
    begin = end + 1;
  }
  std::sort(combination.begin(), combination.end());
  return combination;
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
