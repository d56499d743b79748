// How far two pictures of one size are from each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "core/image_file.h"

namespace ensemble::testing {

/// Pixels of which a channel of the colour differs by more than `most` of 255.
inline std::size_t countDifferences(const Image8& a, const Image8& b, int most = 8) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int difference = 0;
    for (std::size_t k = i; k < i + 3; ++k)
      difference = std::max(difference, std::abs(int{a.rgba[k]} - int{b.rgba[k]}));
    count += difference > most ? 1 : 0;
  }
  return count;
}

}  // namespace ensemble::testing
