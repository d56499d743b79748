// The environment on the device: what stands there and never moves.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/box.h"
#include "core/environment_mesh.h"
#include "renderer/crowd_assets.h"
#include "renderer/texture_store.h"
#include "shaders/shared/crowd_types.h"

namespace ensemble {

/// A piece as the device draws it.
struct EnvironmentItem {
  DrawState state;
  Box bounds;
  std::uint32_t first_index = 0, index_count = 0;
  std::int32_t vertex_offset = 0;
  GpuStaticMaterial material{};
};

class EnvironmentAssets {
 public:
  /// @throws InputError for a damaged texture, SystemError for what does not fit the device
  EnvironmentAssets(gpu::Device& device, const EnvironmentMesh& mesh, const AssetLimits& limits);

  /// In draw order: by state, then as the pieces came.
  const std::vector<EnvironmentItem>& items() const { return items_; }
  const Box& bounds() const { return bounds_; }
  const gpu::Buffer& vertexChunk(std::uint32_t i) const { return vertex_chunks_[i]; }
  const gpu::Buffer& indexChunk(std::uint32_t i) const { return index_chunks_[i]; }
  const TextureStore& textures() const { return *textures_; }
  std::uint64_t meshBytes() const { return mesh_bytes_; }

 private:
  void placePieces(gpu::Device& device, const EnvironmentMesh& mesh, const AssetLimits& limits);
  void setMaterial(const RawMaterial& material, EnvironmentItem& item) const;

  std::vector<EnvironmentItem> items_;
  Box bounds_;
  std::vector<gpu::Buffer> vertex_chunks_, index_chunks_;
  std::unique_ptr<TextureStore> textures_;
  std::uint64_t mesh_bytes_ = 0;
};

}  // namespace ensemble
