// Accessors: typed arrays inside buffers, checked before the first byte is read. Private to
// gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/gltf_document.h"

namespace ensemble {

/// The component types of glTF, by their number in the file.
enum class ComponentType : std::uint16_t {
  kInt8 = 5120,
  kUint8 = 5121,
  kInt16 = 5122,
  kUint16 = 5123,
  kUint32 = 5125,
  kFloat = 5126,
};
std::uint32_t byteSize(ComponentType type);
/// The number from -1 to 1 that a normalised integer stands for.
double fractionOf(double value, ComponentType type);

/// What an accessor says of itself. Its ranges have been checked.
struct GltfAccessor {
  ComponentType component = ComponentType::kFloat;
  std::uint32_t components = 1;  ///< 1 SCALAR, 2..4 VECn, 16 MAT4 (others are refused when read)
  bool normalized = false;
  bool has_data = false;  ///< a bufferView or sparse values; otherwise zeros, or Draco's
  std::uint64_t count = 0;
};

GltfAccessor describeAccessor(const GltfDocument& document, std::uint32_t index);

/// Checks every accessor's ranges. @throws InputError for the first that is wrong.
void checkAccessors(const GltfDocument& document);

/// #count x components floats: normalised integers as the fractions they stand for, others by value.
/// Sparse values applied. @throws InputError if the accessor has not `components` components, or a
/// value is not finite. @pre count has been limited by the caller.
std::vector<float> readFloats(const GltfDocument& document, std::uint32_t index, std::uint32_t components);

/// #count x components unsigned integers (8, 16 or 32 bits). @throws InputError if it is of another type.
std::vector<std::uint32_t> readUnsigned(const GltfDocument& document, std::uint32_t index,
                                        std::uint32_t components);

}  // namespace ensemble
