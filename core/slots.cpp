#include "core/slots.h"

#include <algorithm>

namespace ensemble {
namespace {

constexpr std::array<const char*, kSlotCount> kNames = {"hair", "head", "upper", "lower",
                                                        "full", "feet", "over"};

bool isHalf(Slot slot) { return slot == Slot::kUpper || slot == Slot::kLower; }

}  // namespace

const char* toString(Slot slot) { return kNames[static_cast<std::size_t>(slot)]; }

std::optional<Slot> parseSlot(std::string_view name) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return std::nullopt;
  return kAllSlots[static_cast<std::size_t>(found - kNames.begin())];
}

std::string slotNames() {
  std::string names;
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    names += std::string(i == 0 ? "" : i + 1 < kSlotCount ? ", " : " or ") + kNames[i];
  }
  return names;
}

bool exclude(Slot a, Slot b) {
  return a == b || (a == Slot::kFull && isHalf(b)) || (b == Slot::kFull && isHalf(a));
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
