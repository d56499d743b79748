// Where an item is worn, and which items go together (design 4). Nobody else knows these rules.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ensemble {

/// `full`: a complete outfit, or a dress: in place of upper and lower.
enum class Slot : std::uint8_t { kHair, kHead, kUpper, kLower, kFull, kFeet, kOver };
inline constexpr std::array kAllSlots = {Slot::kHair, Slot::kHead, Slot::kUpper, Slot::kLower,
                                         Slot::kFull, Slot::kFeet, Slot::kOver};
inline constexpr std::size_t kSlotCount = kAllSlots.size();
inline constexpr std::array<std::string_view, kSlotCount> kSlotNames = {"hair", "head", "upper", "lower",
                                                                        "full", "feet", "over"};

const char* toString(Slot slot);  ///< one of kSlotNames
std::optional<Slot> parseSlot(std::string_view name);
std::string slotNames();  ///< for messages: "hair, head, upper, lower, full, feet or over"

/// An array with one entry for each slot.
template <class T>
class PerSlot {
 public:
  T& operator[](Slot slot) { return data_[static_cast<std::size_t>(slot)]; }
  const T& operator[](Slot slot) const { return data_[static_cast<std::size_t>(slot)]; }
  bool operator==(const PerSlot&) const = default;

 private:
  std::array<T, kSlotCount> data_{};
};

/// Whether nobody wears items of both: two of one slot, or `full` with `upper` or `lower`.
bool exclude(Slot a, Slot b);

/// How far out something is worn.
struct WearPlace {
  Slot slot = Slot::kFull;
  int layer = 0;
};
/// Whether one item is worn over another, and may hide some of it. `head` goes over `hair`; `over` goes over
/// `upper`, `lower`, `full` and `feet`; among those four the greater layer goes over the lesser, and of equal
/// layers neither. Hair and hats neither cover clothes nor are covered by them.
bool isWornOver(WearPlace outer, WearPlace inner);

/// Whether a dressed person goes without any item of the slot: not without `upper` and `lower`, or `full`.
bool isOptional(Slot slot);

/// The combinations that dress a person, counted and not listed: an upper and a lower or a full one, and of
/// each other slot one or none. @param items of each slot. None where there are 2^64 or more.
std::optional<std::uint64_t> countCombinations(const PerSlot<std::uint64_t>& items);

}  // namespace ensemble
