#include "cli/picture_error.h"

#include <algorithm>
#include <cstdlib>

#include "core/check.h"

namespace ensemble::cli {

PictureError comparePictures(const Picture& a, const Picture& b) {
  ENSEMBLE_CHECK(a.color.rgba.size() == b.color.rgba.size());
  ENSEMBLE_CHECK(4 * a.character.size() == a.color.rgba.size());
  ENSEMBLE_CHECK(4 * b.character.size() == b.color.rgba.size());
  PictureError error;
  for (std::size_t pixel = 0; pixel < a.character.size(); ++pixel) {
    int difference = 0;
    for (std::size_t k = 4 * pixel; k < 4 * pixel + 4; ++k)
      difference = std::max(difference, std::abs(int{a.color.rgba[k]} - int{b.color.rgba[k]}));
    error.covered += a.character[pixel] != 0 || b.character[pixel] != 0;
    error.differing += difference > kUnseenDifference;
    error.most = std::max(error.most, difference);
  }
  return error;
}

}  // namespace ensemble::cli
