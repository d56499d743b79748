#include "assetpipe/painted_faces.h"

#include <algorithm>

namespace ensemble {

Paint paintOf(const RawPrimitive& primitive, const Triangle& face) {
  if (primitive.hide.empty()) return Paint::kNone;
  const auto all = [&](const auto& test) {
    return std::all_of(face.begin(), face.end(),
                       [&](std::uint32_t corner) { return test(primitive.hide[corner]); });
  };
  if (all([](float value) { return value > 0.5f; })) return Paint::kHide;
  return all([](float value) { return value < -0.5f; }) ? Paint::kKeep : Paint::kNone;
}

}  // namespace ensemble
