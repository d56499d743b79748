#include "renderer/environment_assets.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/input_error.h"

namespace ensemble {
namespace {

/// Arrays that are put into as few buffers as their limit allows, each array into one.
template <class T>
class Chunks {
 public:
  Chunks(gpu::Device& device, vk::BufferUsageFlags usage, std::uint64_t max_bytes)
      : device_(device), usage_(usage), max_bytes_(max_bytes) {}

  /// @return the buffer's number, and the number of the first element in it
  std::pair<std::uint32_t, std::uint32_t> add(const std::vector<T>& elements) {
    const std::uint64_t bytes = elements.size() * sizeof(T);
    if (bytes > max_bytes_) {
      throw SystemError({.file = {},
                         .where = "Vulkan device " + device_.name(),
                         .what = fmt::format("a piece of the environment needs {}, one buffer holds {}",
                                             gpu::describeBytes(bytes), gpu::describeBytes(max_bytes_)),
                         .mend = "use a simpler environment"});
    }
    if (open_.size() * sizeof(T) + bytes > max_bytes_) close();
    const auto first = static_cast<std::uint32_t>(open_.size());
    open_.insert(open_.end(), elements.begin(), elements.end());
    return {static_cast<std::uint32_t>(closed_.size()), first};
  }
  std::vector<gpu::Buffer> finish() {
    close();
    return std::move(closed_);
  }

 private:
  void close() {
    if (open_.empty()) return;
    closed_.push_back(
        gpu::uploadBuffer(device_, std::as_bytes(std::span(open_)), usage_, "a buffer of the environment"));
    open_.clear();
  }

  gpu::Device& device_;
  vk::BufferUsageFlags usage_;
  std::uint64_t max_bytes_;
  std::vector<T> open_;
  std::vector<gpu::Buffer> closed_;
};

}  // namespace

EnvironmentAssets::EnvironmentAssets(gpu::Device& device, const EnvironmentMesh& mesh,
                                     const AssetLimits& limits)
    : bounds_(mesh.bounds) {
  std::vector<TextureStore::Source> sources;
  for (const RawImage& image : mesh.images) sources.push_back({&image, mesh.file});
  textures_ = std::make_unique<TextureStore>(device, sources);
  placePieces(device, mesh, limits);
  std::stable_sort(items_.begin(), items_.end(),
                   [](const EnvironmentItem& a, const EnvironmentItem& b) { return a.state < b.state; });
}

void EnvironmentAssets::placePieces(gpu::Device& device, const EnvironmentMesh& mesh,
                                    const AssetLimits& limits) {
  Chunks<GpuStaticVertex> vertices(device, vk::BufferUsageFlagBits::eVertexBuffer, limits.max_buffer_bytes);
  Chunks<std::uint16_t> indices(device, vk::BufferUsageFlagBits::eIndexBuffer, limits.max_buffer_bytes);
  for (const EnvironmentPiece& piece : mesh.pieces) {
    EnvironmentItem item;
    setMaterial(mesh.materials[piece.material], item);
    item.bounds = piece.bounds;
    const auto [vertex_chunk, first_vertex] = vertices.add(piece.vertices);
    const auto [index_chunk, first_index] = indices.add(piece.indices);
    item.state.vertex_chunk = vertex_chunk;
    item.state.index_chunk = index_chunk;
    item.first_index = first_index;
    item.index_count = static_cast<std::uint32_t>(piece.indices.size());
    item.vertex_offset = static_cast<std::int32_t>(first_vertex);
    mesh_bytes_ +=
        piece.vertices.size() * sizeof(GpuStaticVertex) + piece.indices.size() * sizeof(std::uint16_t);
    items_.push_back(item);
  }
  vertex_chunks_ = vertices.finish();
  index_chunks_ = indices.finish();
}

void EnvironmentAssets::setMaterial(const RawMaterial& material, EnvironmentItem& item) const {
  item.state.double_sided = material.double_sided;
  item.state.cut_out = material.alpha_mode == AlphaMode::kMask;
  item.state.textured = material.image.has_value();
  item.state.texture_set = TextureStore::setIndex(0, true, true);
  item.material.base_color = material.base_color;
  item.material.alpha_cutoff = material.alpha_cutoff;
  if (!material.image) return;
  const StoredTexture& texture = textures_->texture(*material.image);
  item.state.texture_set = TextureStore::setIndex(texture.size_class, material.repeat_u, material.repeat_v);
  item.material.texture_layer = texture.layer;
}

}  // namespace ensemble
