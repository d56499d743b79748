#include "core/slots.h"

#include <algorithm>

namespace ensemble {
namespace {

bool isOnHead(Slot slot) { return slot == Slot::kHair || slot == Slot::kHead; }

bool isHalf(Slot slot) { return slot == Slot::kUpper || slot == Slot::kLower; }

}  // namespace

const char* toString(Slot slot) { return kSlotNames[static_cast<std::size_t>(slot)].data(); }

std::optional<Slot> parseSlot(std::string_view name) {
  const auto found = std::find(kSlotNames.begin(), kSlotNames.end(), name);
  if (found == kSlotNames.end()) return std::nullopt;
  return kAllSlots[static_cast<std::size_t>(found - kSlotNames.begin())];
}

std::string slotNames() {
  std::string names;
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    names += i == 0 ? "" : i + 1 < kSlotCount ? ", " : " or ";
    names += kSlotNames[i];
  }
  return names;
}

bool exclude(Slot a, Slot b) {
  return a == b || (a == Slot::kFull && isHalf(b)) || (b == Slot::kFull && isHalf(a));
}

bool isWornOver(WearPlace outer, WearPlace inner) {
  if (exclude(outer.slot, inner.slot)) return false;
  if (isOnHead(outer.slot) || isOnHead(inner.slot)) {
    return outer.slot == Slot::kHead && inner.slot == Slot::kHair;
  }
  if (outer.slot == Slot::kOver || inner.slot == Slot::kOver) return outer.slot == Slot::kOver;
  return outer.layer > inner.layer;
}

bool isOptional(Slot slot) { return slot != Slot::kFull && !isHalf(slot); }

std::optional<std::uint64_t> countCombinations(const PerSlot<std::uint64_t>& items) {
  std::uint64_t count = 0;
  bool fits = !__builtin_mul_overflow(items[Slot::kUpper], items[Slot::kLower], &count) &&
              !__builtin_add_overflow(count, items[Slot::kFull], &count);
  if (fits && count == 0) return 0;
  for (const Slot slot : kAllSlots) {
    if (!isOptional(slot)) continue;
    std::uint64_t choices = 0;
    fits = fits && !__builtin_add_overflow(items[slot], std::uint64_t{1}, &choices) &&
           !__builtin_mul_overflow(count, choices, &count);
  }
  return fits ? std::optional(count) : std::nullopt;
}

}  // namespace ensemble
