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

/// The parts of "a+b+c"; of "a" itself.
std::vector<std::string> splitOutfit(const std::string& name) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('+', begin), name.size());
    parts.push_back(name.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
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
    if (hasOutfit(w, bare)) names.push_back(scene_.wardrobes[w].key + '/' + bare);
  }
  return names;
}

bool SceneNames::hasOutfit(std::uint32_t wardrobe, const std::string& name) const {
  if (findItem(wardrobe, name).valid()) return true;
  const std::vector<std::string> parts = splitOutfit(name);
  return std::all_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return findItem(wardrobe, part).valid(); });
}

FoundOutfit SceneNames::outfit(const std::string& name, const SourceMark& mark) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    if (hasOutfit(w, name)) found.push_back(w);
  }
  if (found.size() > 1) {
    fail(mark, fmt::format("{} wardrobes have an outfit {}", found.size(), quotedName(name)),
         "write " + quotedList(fullNames(name)));
  }
  if (found.empty()) {
    const std::optional<std::uint32_t> prefix = wardrobePrefix(name);
    if (prefix || wardrobes_.size() == 1) found.push_back(prefix.value_or(0));
  }
  if (!found.empty()) return {found[0], combinationOf(found[0], name, mark)};
  for (const std::string& part : splitOutfit(name)) {
    if (!fullNames(part).empty()) continue;
    fail(mark, fmt::format("no wardrobe has an outfit {}", quotedName(part)), writeNearestOutfit(part));
  }
  fail(mark, fmt::format("no wardrobe has all of {}", quotedName(name)), "write items of one wardrobe");
}

ItemId SceneNames::findItemOf(std::uint32_t wardrobe, const std::string& name) const {
  const ItemId item = findItem(wardrobe, name);
  if (item.valid() || wardrobePrefix(name) != wardrobe) return item;
  return findItem(wardrobe, std::string_view(name).substr(name.find('/') + 1));
}

ItemId SceneNames::outfitOf(std::uint32_t wardrobe, const std::string& name, const SourceMark& mark) const {
  const ItemId item = findItemOf(wardrobe, name);
  if (item.valid()) return item;
  const std::string bare = wardrobePrefix(name) == wardrobe ? name.substr(name.find('/') + 1) : name;
  const std::vector<std::string> known = itemNames(wardrobes_[wardrobe]);
  fail(mark, fmt::format("{} has no outfit {}", describe(wardrobe), quotedName(bare)),
       writeNearest(bare, known, "add outfits to it"));
}

void SceneNames::failNoItem(Slot slot, const std::string& name, const SourceMark& mark) const {
  const std::optional<std::uint32_t> only =
      wardrobes_.size() == 1 ? std::optional<std::uint32_t>(0) : wardrobePrefix(name);
  std::vector<std::string> known;
  for (std::uint32_t w = 0; w < wardrobes_.size(); ++w) {
    if (only && *only != w) continue;
    for (const Item& item : wardrobes_[w].items) {
      if (item.slot != slot || std::find(known.begin(), known.end(), item.name) != known.end()) continue;
      known.push_back(item.name);
    }
  }
  const std::string bare = wardrobePrefix(name) ? name.substr(name.find('/') + 1) : name;
  fail(mark,
       fmt::format("{} item {} of the slot '{}'", only ? describe(*only) + " has no" : "no wardrobe has an",
                   quotedName(bare), toString(slot)),
       writeNearest(bare, known, "add items of the slot"));
}

Combination SceneNames::combinationOf(std::uint32_t wardrobe, const std::string& name,
                                      const SourceMark& mark) const {
  if (name.empty()) return {};
  if (name.find('+') == std::string::npos || findItem(wardrobe, name).valid()) {
    return {outfitOf(wardrobe, name, mark)};
  }
  Combination items;
  for (const std::string& part : splitOutfit(name)) {
    addItem(wardrobe, outfitOf(wardrobe, part, mark), mark, items);
  }
  return items;
}

Combination SceneNames::combinationOf(std::uint32_t wardrobe,
                                      std::span<const Marked<std::string>> names) const {
  Combination items;
  for (const Marked<std::string>& name : names) {
    addItem(wardrobe, outfitOf(wardrobe, name.value, name.mark), name.mark, items);
  }
  return items;
}

/// Keeps the items sorted.
void SceneNames::addItem(std::uint32_t wardrobe, ItemId item, const SourceMark& mark,
                         Combination& items) const {
  const PerItem<Item>& all = wardrobes_[wardrobe].items;
  const Slot slot = all[item].slot;
  for (const ItemId other : items) {
    const Slot others = all[other].slot;
    if (!exclude(slot, others)) continue;
    const std::string first = quotedName(all[other].name), second = quotedName(all[item].name);
    fail(mark,
         slot == others ? fmt::format("{} and {} are both of the slot '{}'", first, second, toString(slot))
                        : fmt::format("{} is of the slot '{}' and {} of '{}', which exclude each other",
                                      first, toString(others), second, toString(slot)),
         "write one of them");
  }
  items.insert(std::upper_bound(items.begin(), items.end(), item), item);
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
