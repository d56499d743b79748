// KHR_draco_mesh_compression, by libdraco. Private to gltf_file.h's implementation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/gltf_accessor.h"
#include "core/gltf_file.h"
#include "core/gltf_json.h"

namespace draco {
class Mesh;
}

namespace ensemble {

/// A decompressed primitive.
class DracoMesh {
 public:
  /// @param ref where the compressed primitive stands, for messages. Refuses data that announce more
  /// than `max_faces` faces or `max_vertices` vertices before decompressing them.
  DracoMesh(const JsonRef& ref, std::span<const std::byte> bytes, std::uint64_t max_faces,
            std::uint64_t max_vertices);
  ~DracoMesh();
  DracoMesh(DracoMesh&&) noexcept;

  std::uint64_t vertexCount() const;
  std::vector<std::uint32_t> indices() const;  ///< three a face, each below vertexCount()

  /// #V x components. `unique_id` is what the extension's `attributes` name. @throws InputError
  std::vector<float> floats(const JsonRef& unique_id, const GltfAccessor& accessor) const;
  std::vector<std::uint32_t> unsignedIntegers(const JsonRef& unique_id, const GltfAccessor& accessor) const;

 private:
  std::unique_ptr<draco::Mesh> mesh_;
};

/// A primitive as Draco data: sequential, without deduplication, so that the numbers of vertices and
/// faces stay.
struct DracoData {
  std::vector<std::byte> bytes;
  std::map<std::string, std::uint32_t> attribute_ids;  ///< by glTF's name
  Vec3 position_min{0.0f}, position_max{0.0f};         ///< of the decompressed positions
};

/// Which attributes of a primitive a file holds.
struct PrimitiveLayout {
  bool uv = false;
  bool skin = false;
  bool wide_joints = false;  ///< 16-bit joint numbers
  bool template_vertices = false;
  bool collapses = false;
  bool wide_collapses = false;  ///< targets beyond 16 bits
};

/// `_COLLAPSE` as a file holds it: target and level of each vertex, #V x 2.
template <class T>
std::vector<T> collapseValues(const RawPrimitive& primitive) {
  std::vector<T> values;
  for (const VertexCollapse& collapse : primitive.collapses)
    values.insert(values.end(), {static_cast<T>(collapse.target), static_cast<T>(collapse.level)});
  return values;
}

/// @pre the primitive has faces and its indices are in range.
DracoData encodeDraco(const RawPrimitive& primitive, const PrimitiveLayout& layout,
                      const GlbWriteOptions& options);

}  // namespace ensemble
