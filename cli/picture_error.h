// How far two pictures of the same frame are apart.
#pragma once

#include <cstdint>

#include "renderer/view.h"

namespace ensemble::cli {

/// Differences below what is seen: a channel, of 255.
inline constexpr int kUnseenDifference = 8;

struct PictureError {
  std::uint64_t covered = 0;    ///< pixels where a person shows in one picture or the other
  std::uint64_t differing = 0;  ///< pixels of which a channel differs by more than kUnseenDifference
  int most = 0;                 ///< greatest difference of a channel, 0 .. 255

  /// Of the pixels that people cover; 0 where nobody shows. What differs elsewhere (a shadow on the ground, a
  /// silhouette whose centre is not covered) counts as well, so that it may exceed 1.
  double share() const {
    return covered > 0 ? static_cast<double>(differing) / static_cast<double>(covered) : 0.0;
  }
};

/// @pre both are of one size, and have the AOV `character`
PictureError comparePictures(const Picture& a, const Picture& b);

}  // namespace ensemble::cli
