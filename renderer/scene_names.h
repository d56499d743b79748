// The names in a scene, looked up in its wardrobes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene.h"
#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"

namespace ensemble {

/// An item of one of the scene's wardrobes, or several that go together.
struct FoundOutfit {
  std::uint32_t wardrobe = 0;
  Combination items;
};

/// The items of a combination by name, joined by '+'; empty for the bare body.
std::string outfitName(const Wardrobe& wardrobe, const Combination& items);

/// Every lookup throws InputError at the name's place in its file, naming the nearest names.
class SceneNames {
 public:
  /// Scene and wardrobes must outlive this. @param file where the names stand; empty: the scene's file
  /// @pre one wardrobe for each of scene.wardrobes
  SceneNames(const Scene& scene, std::span<const Wardrobe> wardrobes, std::filesystem::path file = {});

  std::uint32_t wardrobe(const std::string& key, const SourceMark& mark) const;
  /// The only one, where the key is empty; where there are several, the message says that `who` names none
  /// of them, and to mend it, `how` with their keys.
  std::uint32_t wardrobeOrOnly(const Marked<std::string>& key, const std::string& who, const char* how) const;
  /// A bare name that one wardrobe has, or KEY/NAME; a name is an item's, or several joined by '+'.
  FoundOutfit outfit(const std::string& name, const SourceMark& mark) const;
  /// A bare name, or KEY/NAME of that wardrobe.
  ItemId outfitOf(std::uint32_t wardrobe, const std::string& name, const SourceMark& mark) const;
  /// The same, none() where the wardrobe has no such item.
  ItemId findItemOf(std::uint32_t wardrobe, const std::string& name) const;
  /// As outfitName writes it: an item's name, or several joined by '+', of slots that go together.
  Combination combinationOf(std::uint32_t wardrobe, const std::string& name, const SourceMark& mark) const;
  Combination combinationOf(std::uint32_t wardrobe, std::span<const Marked<std::string>> names) const;
  std::uint32_t clipOf(std::uint32_t wardrobe, const std::string& name, const SourceMark& mark) const;

  /// For messages: "the wardrobe 'women'", or its folder where it has no key.
  std::string describe(std::uint32_t wardrobe) const;
  [[noreturn]] void fail(const SourceMark& mark, const std::string& what, const std::string& mend) const;
  /// No wardrobe has an item of this name; names the nearest of the slot.
  [[noreturn]] void failNoItem(Slot slot, const std::string& name, const SourceMark& mark) const;

 private:
  ItemId findItem(std::uint32_t wardrobe, std::string_view name) const;
  /// The wardrobe before the '/' of KEY/NAME, if there is one.
  std::optional<std::uint32_t> wardrobePrefix(const std::string& name) const;
  /// Whether a wardrobe has the item, or all items that are joined by '+'.
  bool hasOutfit(std::uint32_t wardrobe, const std::string& name) const;
  void addItem(std::uint32_t wardrobe, ItemId item, const SourceMark& mark, Combination& items) const;
  /// KEY/NAME in every wardrobe that has it.
  std::vector<std::string> fullNames(const std::string& bare) const;
  std::string writeNearestOutfit(const std::string& name) const;

  const Scene& scene_;
  std::span<const Wardrobe> wardrobes_;
  std::filesystem::path file_;
};

}  // namespace ensemble
