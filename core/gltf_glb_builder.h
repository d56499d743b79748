// The container of a GLB in the making: buffer views, accessors, chunks. Private to gltf_file.h's
// implementation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/math.h"

namespace ensemble {

/// What a buffer view holds; accessors of a kind share one view.
/// (The Khronos validator wants inverse bind matrices apart from other data.)
enum class ViewKind {
  kIndices,
  kPosition,
  kNormal,
  kUv,
  kJoints,
  kWeights,
  kTemplateVertex,
  kCollapse,
  kWideCollapse,
  kInverseBind,
  kAnimation,
};
inline constexpr std::size_t kViewKindCount = 11;

/// What an accessor says of its numbers.
struct AccessorShape {
  const char* type = "SCALAR";
  int component_type = 5126;  ///< FLOAT
};

/// Collects binary data and the JSON that describes them.
class GlbBuilder {
 public:
  using Json = nlohmann::ordered_json;

  Json json = Json::object();  ///< everything but buffers, bufferViews and accessors

  /// Appends an accessor over `values`, tightly packed, `count` elements. Returns its index.
  template <class T>
  std::size_t addAccessor(ViewKind kind, std::span<const T> values, std::size_t count, AccessorShape shape) {
    return addAccessor(kind, std::as_bytes(values), count, shape);
  }
  std::size_t addAccessor(ViewKind kind, std::span<const std::byte> bytes, std::size_t count,
                          AccessorShape shape);
  /// An accessor without data of its own, as Draco wants it.
  std::size_t addEmptyAccessor(std::size_t count, AccessorShape shape);
  void setBounds(std::size_t accessor, std::span<const float> min, std::span<const float> max);

  /// A view of its own for one block of data (an image, Draco data). Returns its index.
  std::size_t addView(std::span<const std::byte> bytes);

  /// The whole file. @throws SystemError if it would have 4 GiB or more.
  std::vector<std::byte> finish();

 private:
  struct View {
    std::vector<std::byte> bytes;
    std::uint32_t stride = 0;
    int target = 0;
  };

  std::vector<View> views_;
  std::array<std::optional<std::size_t>, kViewKindCount> view_of_kind_;
  Json accessors_ = Json::array();
};

}  // namespace ensemble
