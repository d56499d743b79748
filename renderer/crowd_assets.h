// What is drawn, on the device: meshes, sub-meshes, materials, and which faces are hidden.
//
// Made once per scene from the sub-mesh lists of its wardrobes. All wardrobes share one list of
// sub-meshes in draw order, so that one set of queues serves the whole crowd.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "renderer/texture_store.h"
#include "renderer/vk/memory.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// Draws of one state follow each other and go to the device in one call.
struct DrawState {
  bool is_body = false;  ///< garments are drawn before skin
  bool double_sided = false;
  bool textured = false;
  bool cut_out = false;      ///< fragments are discarded by alpha
  bool hides_faces = false;  ///< naive: hidden faces cast no shadow
  std::uint32_t texture_set = 0;
  std::uint32_t index_chunk = 0;
  std::uint32_t vertex_chunk = 0;
  auto operator<=>(const DrawState&) const = default;
};

/// A sub-mesh as the device draws it.
struct DrawItem {
  DrawState state;
  std::uint32_t first_index = 0, index_count = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t mesh = 0;  ///< index into CrowdAssets::meshes
  std::uint32_t list = 0;  ///< index list, in the lists of its wardrobe
  GpuDraw gpu{};
};

/// Where a mesh is.
struct DrawMesh {
  std::uint32_t wardrobe = 0;
  MeshId id;  ///< in the wardrobe's lists
  std::uint32_t vertex_chunk = 0, first_vertex = 0, vertex_count = 0;
};

/// Texel views are for compute shaders.
struct VertexChunk {
  gpu::Buffer vertices;
  vk::raii::BufferView texels = nullptr;  ///< two 32-bit words each
};

struct IndexChunk {
  vk::IndexType type = vk::IndexType::eUint16;
  gpu::Buffer indices;
  vk::raii::BufferView texels = nullptr;  ///< 32 bits each: one index, or two
  gpu::Buffer source_faces;
};

struct AssetLimits {
  std::uint64_t max_buffer_bytes = 128ull << 20;  ///< of any one buffer
};

class CrowdAssets {
 public:
  struct WardrobeInput {
    const SubMeshLists* lists = nullptr;
    std::string file;                ///< for messages
    std::uint32_t fixed_joint = 0;   ///< the joint that never moves (Animation)
    std::uint32_t region_count = 0;  ///< of the template
    Vec3 skin{0.5f};                 ///< the template's mean skin colour, linear: what tints replace
  };
  struct Input {
    std::vector<WardrobeInput> wardrobes;
    /// The crowd's combinations, in order: wardrobe, and combination in its lists.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> combinations;
    AssetLimits limits;
  };
  /// @throws InputError for a damaged texture, SystemError for what does not fit the device
  CrowdAssets(gpu::Device& device, const Input& input);

  /// Sub-meshes in draw order; SubMeshId counts these.
  const std::vector<DrawItem>& items() const { return items_; }
  /// Per combination of the crowd its sub-meshes, ascending.
  const std::vector<std::vector<SubMeshId>>& shown() const { return shown_; }
  const std::vector<DrawMesh>& meshes() const { return meshes_; }
  const VertexChunk& vertexChunk(std::uint32_t i) const { return vertex_chunks_[i]; }
  const IndexChunk& indexChunk(std::uint32_t i) const { return index_chunks_[i]; }
  std::size_t vertexChunkCount() const { return vertex_chunks_.size(); }
  std::size_t indexChunkCount() const { return index_chunks_.size(); }
  const gpu::Buffer& materials() const { return materials_; }
  const gpu::Buffer& tints() const { return tints_; }
  const gpu::Buffer& hiddenFirst() const { return hidden_first_; }
  const gpu::Buffer& hiddenWords() const { return hidden_words_; }
  const TextureStore& textures() const { return *textures_; }
  std::uint64_t meshBytes() const { return mesh_bytes_; }
  /// AOV numbers: region r of a template is 1 + r, garment g (over all wardrobes) is this + g.
  std::uint32_t firstGarmentNumber() const { return first_garment_number_; }

 private:
  class Builder;
  std::vector<DrawItem> items_;
  std::vector<DrawMesh> meshes_;
  std::vector<std::vector<SubMeshId>> shown_;
  std::vector<VertexChunk> vertex_chunks_;
  std::vector<IndexChunk> index_chunks_;
  gpu::Buffer materials_, tints_, hidden_first_, hidden_words_;
  std::unique_ptr<TextureStore> textures_;
  std::uint64_t mesh_bytes_ = 0;
  std::uint32_t first_garment_number_ = 1;
};

}  // namespace ensemble
