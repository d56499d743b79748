// glTF 2.0, sections 3.6.2 (accessors) and 3.6.2.3 (sparse).
#include "core/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace ensemble {
namespace {

ComponentType readComponentType(const JsonRef& value) {
  const std::uint64_t type = value.wholeNumber(0xffff);
  for (const auto known : {ComponentType::kInt8, ComponentType::kUint8, ComponentType::kInt16,
                           ComponentType::kUint16, ComponentType::kUint32, ComponentType::kFloat}) {
    if (type == static_cast<std::uint64_t>(known)) return known;
  }
  value.fail(fmt::format("componentType {} does not exist", type));
}

std::uint32_t componentCount(const JsonRef& value) {
  const std::string& type = value.string();
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4" || type == "MAT2") return 4;
  if (type == "MAT3") return 9;
  if (type == "MAT4") return 16;
  value.fail(fmt::format("type '{}' does not exist", type));
}

/// Equal steps through a view.
struct Elements {
  std::span<const std::byte> bytes;  ///< from the first element on
  std::uint64_t stride = 0;
  const std::byte* at(std::uint64_t index) const { return bytes.data() + index * stride; }
};

/// Where an array of `count` elements of `size` bytes lies in a view.
struct Range {
  std::uint64_t count = 0, size = 0, alignment = 1;
};

// Checks that the elements lie inside the view. count < 2^32 and stride <= 252 can't overflow.
Elements findElements(const GltfDocument& document, const JsonRef& owner, const Range& range) {
  const std::uint32_t view_index = document.index(owner.require("bufferView"), "bufferViews");
  const GltfBufferView& view = document.view(view_index);
  const std::uint64_t offset = owner.wholeNumberOr("byteOffset", 0, 1ull << 53);
  const std::uint64_t stride = view.stride == 0 ? range.size : view.stride;
  if (offset % range.alignment != 0) {
    owner.fail(fmt::format("byteOffset {} is no multiple of {}", offset, range.alignment));
  }
  if (stride < range.size) {
    owner.fail(fmt::format("elements of {} bytes do not fit a stride of {}", range.size, stride));
  }
  const std::uint64_t needed = range.count == 0 ? 0 : (range.count - 1) * stride + range.size;
  if (offset > view.bytes.size() || needed > view.bytes.size() - offset) {
    owner.fail(fmt::format("{} elements need {} bytes from byte {}, bufferView {} has {}", range.count,
                           needed, offset, view_index, view.bytes.size()));
  }
  return {view.bytes.subspan(offset), stride};
}

template <class T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));  // all our machines are little-endian, as glTF is
  return value;
}

double loadNumber(const std::byte* bytes, ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
      return load<std::int8_t>(bytes);
    case ComponentType::kUint8:
      return load<std::uint8_t>(bytes);
    case ComponentType::kInt16:
      return load<std::int16_t>(bytes);
    case ComponentType::kUint16:
      return load<std::uint16_t>(bytes);
    case ComponentType::kUint32:
      return load<std::uint32_t>(bytes);
    case ComponentType::kFloat:
      return static_cast<double>(load<float>(bytes));
  }
  return 0.0;
}

/// The sparse part of an accessor: which elements it replaces, and by what.
struct Sparse {
  std::uint64_t count = 0;
  Elements indices, values;
  ComponentType index_type = ComponentType::kUint16;
};

Sparse findSparse(const GltfDocument& document, const JsonRef& sparse, const GltfAccessor& accessor) {
  Sparse result;
  result.count = sparse.require("count").wholeNumber(accessor.count);
  const JsonRef indices = sparse.require("indices");
  result.index_type = readComponentType(indices.require("componentType"));
  if (result.index_type != ComponentType::kUint8 && result.index_type != ComponentType::kUint16 &&
      result.index_type != ComponentType::kUint32) {
    indices.fail("sparse indices must be unsigned integers");
  }
  const std::uint64_t index_size = byteSize(result.index_type);
  result.indices = findElements(document, indices, {result.count, index_size, index_size});
  const std::uint64_t size = byteSize(accessor.component) * accessor.components;
  result.values =
      findElements(document, sparse.require("values"), {result.count, size, byteSize(accessor.component)});
  return result;
}

void checkSparseOrder(const JsonRef& sparse, const Sparse& result, const GltfAccessor& accessor) {
  const JsonRef indices = sparse.require("indices");
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < result.count; ++i) {
    const auto index = static_cast<std::uint64_t>(loadNumber(result.indices.at(i), result.index_type));
    if (index < next || index >= accessor.count) {
      indices.fail(fmt::format("sparse index {} is out of order or not below {}", index, accessor.count));
    }
    next = index + 1;
  }
}

GltfAccessor describe(const JsonRef& json) {
  GltfAccessor accessor;
  accessor.component = readComponentType(json.require("componentType"));
  accessor.components = componentCount(json.require("type"));
  accessor.normalized = json.booleanOr("normalized", false);
  accessor.count = json.require("count").wholeNumber(0xffffffffu);
  accessor.has_data = json.has("bufferView") || json.has("sparse");
  return accessor;
}

void requireComponents(const JsonRef& json, const GltfAccessor& accessor, std::uint32_t components) {
  if (accessor.components != components) {
    json.fail(fmt::format("expected {} components, found {}", components, json.require("type").string()));
  }
}

// Calls visit(element, bytes) for each element that has data, sparse ones last.
template <class Visit>
void visitElements(const GltfDocument& document, const JsonRef& json, const GltfAccessor& accessor,
                   const Visit& visit) {
  const std::uint64_t size = byteSize(accessor.component) * accessor.components;
  if (json.has("bufferView")) {
    const Elements elements =
        findElements(document, json, {accessor.count, size, byteSize(accessor.component)});
    for (std::uint64_t i = 0; i < accessor.count; ++i) visit(i, elements.at(i));
  }
  if (const auto sparse_json = json.find("sparse")) {
    const Sparse sparse = findSparse(document, *sparse_json, accessor);
    checkSparseOrder(*sparse_json, sparse, accessor);
    for (std::uint64_t i = 0; i < sparse.count; ++i) {
      visit(static_cast<std::uint64_t>(loadNumber(sparse.indices.at(i), sparse.index_type)),
            sparse.values.at(i));
    }
  }
}

}  // namespace

std::uint32_t byteSize(ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
    case ComponentType::kUint8:
      return 1;
    case ComponentType::kInt16:
    case ComponentType::kUint16:
      return 2;
    case ComponentType::kUint32:
    case ComponentType::kFloat:
      return 4;
  }
  return 4;
}

double fractionOf(double value, ComponentType type) {
  switch (type) {
    case ComponentType::kInt8:
      return std::max(value / 127.0, -1.0);
    case ComponentType::kUint8:
      return value / 255.0;
    case ComponentType::kInt16:
      return std::max(value / 32767.0, -1.0);
    case ComponentType::kUint16:
      return value / 65535.0;
    case ComponentType::kUint32:
      return value / 4294967295.0;
    case ComponentType::kFloat:
      break;
  }
  return value;
}

GltfAccessor describeAccessor(const GltfDocument& document, std::uint32_t index) {
  return describe(document.item("accessors", index));
}

void checkAccessors(const GltfDocument& document) {
  const std::size_t accessor_count = document.count("accessors");
  for (std::size_t i = 0; i < accessor_count; ++i) {
    const JsonRef json = document.item("accessors", i);
    const GltfAccessor accessor = describe(json);
    const std::uint64_t size = byteSize(accessor.component) * accessor.components;
    if (json.has("bufferView")) {
      findElements(document, json, {accessor.count, size, byteSize(accessor.component)});
    }
    if (const auto sparse = json.find("sparse")) findSparse(document, *sparse, accessor);
  }
}

std::vector<float> readFloats(const GltfDocument& document, std::uint32_t index, std::uint32_t components) {
  const JsonRef json = document.item("accessors", index);
  const GltfAccessor accessor = describe(json);
  requireComponents(json, accessor, components);
  std::vector<float> result(accessor.count * components, 0.0f);
  const std::uint32_t step = byteSize(accessor.component);
  visitElements(document, json, accessor, [&](std::uint64_t element, const std::byte* bytes) {
    for (std::uint32_t c = 0; c < components; ++c) {
      double value = loadNumber(bytes + c * step, accessor.component);
      if (accessor.normalized) value = fractionOf(value, accessor.component);
      if (!std::isfinite(value)) {
        json.fail(fmt::format("element {} is not a finite number", element),
                  "remove the damaged vertex or key and " + std::string(kExportAgain));
      }
      result[element * components + c] = static_cast<float>(value);
    }
  });
  return result;
}

std::vector<std::uint32_t> readUnsigned(const GltfDocument& document, std::uint32_t index,
                                        std::uint32_t components) {
  const JsonRef json = document.item("accessors", index);
  const GltfAccessor accessor = describe(json);
  requireComponents(json, accessor, components);
  if ((accessor.component != ComponentType::kUint8 && accessor.component != ComponentType::kUint16 &&
       accessor.component != ComponentType::kUint32) ||
      accessor.normalized) {
    json.fail("expected unsigned integers");
  }
  std::vector<std::uint32_t> result(accessor.count * components, 0);
  const std::uint32_t step = byteSize(accessor.component);
  visitElements(document, json, accessor, [&](std::uint64_t element, const std::byte* bytes) {
    for (std::uint32_t c = 0; c < components; ++c) {
      result[element * components + c] =
          static_cast<std::uint32_t>(loadNumber(bytes + c * step, accessor.component));
    }
  });
  return result;
}

}  // namespace ensemble
