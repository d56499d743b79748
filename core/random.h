// Random numbers by counting: a pure function of (seed, stream, index), without state.
//
// Who draws first changes nothing, so that people can be made in any order or in parallel, and
// one more property of a person leaves the others as they were. The bits are those of SplitMix64
// (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014), whose
// counter starts at a hash of seed and stream. Only 64-bit integers and exact conversions are
// used: the same numbers on every machine and compiler. A change here changes every crowd.
#pragma once

#include <cstdint>

namespace ensemble {

/// SplitMix64's output function: a bijection that spreads every bit over all.
constexpr std::uint64_t mixBits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// One seed and stream; numbers are drawn by index. Streams are independent for practical purposes.
class RandomStream {
 public:
  constexpr RandomStream(std::uint64_t seed, std::uint64_t stream)
      : base_(mixBits(mixBits(seed + kStep) ^ (stream * kStep + kStep))) {}

  constexpr std::uint64_t bits(std::uint64_t index) const { return mixBits(base_ + (index + 1) * kStep); }
  constexpr std::uint32_t bits32(std::uint64_t index) const {
    return static_cast<std::uint32_t>(bits(index) >> 32);
  }
  /// Uniform in [0, 1), a multiple of 2^-53.
  constexpr double uniform(std::uint64_t index) const {
    return static_cast<double>(bits(index) >> 11) * 0x1.0p-53;
  }
  /// Uniform in [0, 1), a multiple of 2^-24: exact in a float.
  constexpr float uniformFloat(std::uint64_t index) const {
    return static_cast<float>(bits(index) >> 40) * 0x1.0p-24f;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;  // 2^64 / golden ratio, odd
  std::uint64_t base_;
};

}  // namespace ensemble
