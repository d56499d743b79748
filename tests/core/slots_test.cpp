#include "core/slots.h"

#include <gtest/gtest.h>

namespace ensemble {
namespace {

TEST(Slots, HaveNamesThatReadBack) {
  for (const Slot slot : kAllSlots) EXPECT_EQ(parseSlot(toString(slot)), slot);
  EXPECT_FALSE(parseSlot("top").has_value());
  EXPECT_FALSE(parseSlot("").has_value());
  EXPECT_EQ(slotNames(), "hair, head, upper, lower, full, feet or over");
}

TEST(Slots, ExcludeThemselvesAndFullTheHalves) {
  for (const Slot a : kAllSlots) {
    for (const Slot b : kAllSlots) {
      const bool is_half = a == Slot::kUpper || a == Slot::kLower;
      const bool is_other_half = b == Slot::kUpper || b == Slot::kLower;
      const bool expected = a == b || (a == Slot::kFull && is_other_half) || (b == Slot::kFull && is_half);
      EXPECT_EQ(exclude(a, b), expected) << toString(a) << " " << toString(b);
    }
  }
}

TEST(Slots, WhatIsWornOverWhat) {
  const auto over = [](Slot outer, int outer_layer, Slot inner, int inner_layer) {
    return isWornOver({outer, outer_layer}, {inner, inner_layer});
  };
  EXPECT_TRUE(over(Slot::kHead, 0, Slot::kHair, 9)) << "whatever the layers";
  EXPECT_FALSE(over(Slot::kHair, 9, Slot::kHead, 0));
  EXPECT_TRUE(over(Slot::kOver, 0, Slot::kUpper, 9));
  EXPECT_TRUE(over(Slot::kUpper, 20, Slot::kLower, 10));
  EXPECT_FALSE(over(Slot::kLower, 10, Slot::kUpper, 20));
  EXPECT_TRUE(over(Slot::kFeet, 16, Slot::kLower, 10));
  EXPECT_TRUE(over(Slot::kFull, 17, Slot::kFeet, 16));
  EXPECT_FALSE(over(Slot::kUpper, 5, Slot::kLower, 5)) << "equal layers";
  EXPECT_FALSE(over(Slot::kOver, 9, Slot::kHair, 0)) << "hair hangs over a coat, or into it";
  EXPECT_FALSE(over(Slot::kFull, 9, Slot::kUpper, 0)) << "nobody wears both";
  for (const Slot a : kAllSlots) {
    for (const Slot b : kAllSlots) {
      for (const int layer : {0, 1}) {
        EXPECT_FALSE(over(a, layer, b, 0) && over(b, 0, a, layer)) << toString(a) << " " << toString(b);
      }
    }
  }
}

/// Goes through all combinations, as the count must not.
std::uint64_t listed(const PerSlot<std::uint64_t>& items) {
  std::uint64_t count = 0;
  const auto n = [&](Slot slot) { return items[slot]; };
  for (std::uint64_t upper = 0; upper <= n(Slot::kUpper); ++upper) {
    for (std::uint64_t lower = 0; lower <= n(Slot::kLower); ++lower) {
      for (std::uint64_t full = 0; full <= n(Slot::kFull); ++full) {
        const bool is_dressed = full > 0 ? upper + lower == 0 : upper > 0 && lower > 0;
        if (!is_dressed) continue;
        for (std::uint64_t hair = 0; hair <= n(Slot::kHair); ++hair) {
          for (std::uint64_t head = 0; head <= n(Slot::kHead); ++head) {
            count += (n(Slot::kFeet) + 1) * (n(Slot::kOver) + 1);
          }
        }
      }
    }
  }
  return count;
}

TEST(Slots, CombinationsAreCountedExactly) {
  PerSlot<std::uint64_t> items;
  EXPECT_EQ(countCombinations(items), 0u);
  items[Slot::kUpper] = 3;
  EXPECT_EQ(countCombinations(items), 0u) << "an upper without a lower";
  items[Slot::kLower] = 4;
  EXPECT_EQ(countCombinations(items), 12u);
  items[Slot::kFull] = 2;
  EXPECT_EQ(countCombinations(items), 14u);
  items[Slot::kHair] = 2;
  items[Slot::kHead] = 1;
  items[Slot::kFeet] = 3;
  items[Slot::kOver] = 2;
  EXPECT_EQ(countCombinations(items), listed(items));
  EXPECT_EQ(countCombinations(items), 14u * 3 * 2 * 4 * 3);
}

TEST(Slots, ACountBeyond64BitsIsNone) {
  PerSlot<std::uint64_t> items;
  items[Slot::kFull] = 1ull << 32;
  items[Slot::kHair] = (1ull << 32) - 1;
  EXPECT_FALSE(countCombinations(items).has_value());
  items[Slot::kFull] -= 1;
  EXPECT_EQ(countCombinations(items), 0xffffffffull << 32);
  items[Slot::kUpper] = items[Slot::kLower] = 1ull << 32;
  EXPECT_FALSE(countCombinations(items).has_value());
}

}  // namespace
}  // namespace ensemble
