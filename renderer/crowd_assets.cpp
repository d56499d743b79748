#include "renderer/crowd_assets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <optional>

#include "core/check.h"
#include "core/input_error.h"
#include "renderer/garment_parts.h"
#include "renderer/tints.h"
#include "shaders/shared/vertex.h"

namespace ensemble {
namespace {

constexpr float kDarkestReference = 0.02f;  // A tint of a black texture would be infinite.
constexpr float kMostShade = 3.0f;          // A trimming this much brighter than its item is a contrast.

std::span<const std::byte> bytesOf(const auto& vector) { return std::as_bytes(std::span(vector)); }

/// Where an index list went.
struct PlacedList {
  std::uint32_t index_chunk = 0, vertex_chunk = 0;
  std::uint32_t first_index = 0, first_face = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t mesh = 0;
};

/// Where a mesh went.
struct PlacedMesh {
  std::uint32_t chunk = 0;
  std::int32_t vertex_offset = 0;
  std::uint32_t number = 0;  ///< in CrowdAssets::meshes
};

/// Content of a chunk while it is filled.
struct OpenIndexChunk {
  bool wide = false;
  std::vector<std::uint32_t> indices, source_faces;
  std::uint64_t indexBytes() const { return indices.size() * (wide ? 4u : 2u); }
};

}  // namespace

/// Collects everything on the host, then uploads it.
class CrowdAssets::Builder {
 public:
  Builder(CrowdAssets& assets, gpu::Device& device, const Input& input)
      : assets_(assets), device_(device), input_(input), numbers_(input.wardrobes.size()) {}

  void build() {
    collectTextures();
    for (std::uint32_t w = 0; w < input_.wardrobes.size(); ++w) {
      assets_.mesh_bytes_ += lists(w).meshBytes();
      assets_.first_garment_number_ =
          std::max(assets_.first_garment_number_, 1 + input_.wardrobes[w].region_count);
      numbers_[w].first_garment = garment_count_;
      garment_count_ += static_cast<std::uint32_t>(lists(w).garment_names.size());
    }
    // Garments' meshes first: they are the same in every technique, and so are then their chunks
    // and their places in the draw order.
    for (const SubMeshKind kind : {SubMeshKind::kGarment, SubMeshKind::kBody}) {
      for (std::uint32_t w = 0; w < input_.wardrobes.size(); ++w) addItems(w, kind);
    }
    sortItems();
    addCombinations();
    upload();
  }

 private:
  const SubMeshLists& lists(std::uint32_t wardrobe) const { return *input_.wardrobes[wardrobe].lists; }

  void checkSize(std::uint64_t bytes, const char* what) const {
    if (bytes <= input_.limits.max_buffer_bytes) return;
    throw SystemError(
        {.file = {},
         .where = "Vulkan device " + device_.name(),
         .what = fmt::format("{} needs {}, one buffer holds {}", what, gpu::describeBytes(bytes),
                             gpu::describeBytes(input_.limits.max_buffer_bytes)),
         .mend = "use smaller meshes or fewer combinations"});
  }

  void collectTextures() {
    std::vector<TextureStore::Source> sources;
    for (std::uint32_t w = 0; w < input_.wardrobes.size(); ++w) {
      numbers_[w].first_texture = sources.size();
      for (const RawImage& image : lists(w).images) sources.push_back({&image, input_.wardrobes[w].file});
    }
    assets_.textures_ = std::make_unique<TextureStore>(device_, sources);
  }

  /// A material's colour where no tint is: its factor times the mean of its texture.
  Vec3 meanOf(std::uint32_t w, const RawMaterial& raw) const {
    Vec3 mean(raw.base_color);
    if (raw.image) mean *= assets_.textures_->texture(numbers_[w].first_texture + *raw.image).mean;
    return mean;
  }

  /// The material that a sub-mesh is tinted as: of trimmings that of their item or garment.
  const ListMaterial& tintedAs(std::uint32_t w, const SubMesh& sub_mesh) const {
    const ListMaterial& own = lists(w).materials[sub_mesh.material];
    if (sub_mesh.kind == SubMeshKind::kBody) return own;
    const ListMaterial& main = lists(w).materials[sub_mesh.main_material];
    return tintKindOf(main.material.name, false) == tintKindOf(own.material.name, false) ? main : own;
  }

  GpuMaterial makeMaterial(std::uint32_t w, const SubMesh& sub_mesh) const {
    const ListMaterial& from = lists(w).materials[sub_mesh.material];
    const RawMaterial& raw = from.material;
    const RawMaterial& main = tintedAs(w, sub_mesh).material;
    GpuMaterial material{};
    material.base_color = raw.base_color;
    material.alpha_cutoff = raw.alpha_cutoff;
    if (raw.image) {
      material.texture_layer = assets_.textures_->texture(numbers_[w].first_texture + *raw.image).layer;
    }
    const TintKind kind = tintKindOf(raw.name, from.is_skin);
    const TintRange range = tintRange(kind);
    const Vec3 mean = glm::max(kind == TintKind::kSkin ? input_.wardrobes[w].skin : meanOf(w, main),
                               Vec3(kDarkestReference));
    // Trimmings keep their shade of the item's colour; contrasts, such as white stripes, stay as they are.
    const bool contrasts = glm::any(glm::greaterThan(meanOf(w, raw), kMostShade * mean));
    const float strength = main.image ? range.textured_strength : range.strength;
    material.tint = Vec4(1.0f / mean, &main != &raw && contrasts ? 0.0f : strength);
    material.tint_first = range.first;
    const bool is_lower = sub_mesh.slot == Slot::kLower && range.lower_count > 0;
    material.tint_count = is_lower ? range.lower_count : range.count;
    material.tint_spread = range.spread;
    material.sheen = range.sheen;
    // Only a complete outfit is a shirt and trousers in one; a belt tells nothing of the kind.
    const bool may_be_two = sub_mesh.slot == Slot::kFull && !sub_mesh.has_trimmings;
    material.lower_tint_count = may_be_two ? range.lower_count : 0;
    return material;
  }

  PlacedMesh placeMesh(std::uint32_t w, MeshId id) {
    auto& placed = numbers_[w].meshes;
    placed.resize(lists(w).meshes.size());
    if (placed[id.value]) return *placed[id.value];
    const Mesh& mesh = lists(w).meshes[id];
    const std::uint64_t bytes = mesh.vertices.size() * sizeof(GpuVertex);
    checkSize(bytes, "a mesh");
    if (vertices_.empty() ||
        vertices_.back().size() * sizeof(GpuVertex) + bytes > input_.limits.max_buffer_bytes) {
      vertices_.emplace_back();
    }
    std::vector<GpuVertex>& chunk = vertices_.back();
    placed[id.value] =
        PlacedMesh{static_cast<std::uint32_t>(vertices_.size() - 1), static_cast<std::int32_t>(chunk.size()),
                   static_cast<std::uint32_t>(assets_.meshes_.size())};
    assets_.meshes_.push_back({.wardrobe = w,
                               .id = id,
                               .vertex_chunk = placed[id.value]->chunk,
                               .first_vertex = static_cast<std::uint32_t>(chunk.size()),
                               .vertex_count = static_cast<std::uint32_t>(mesh.vertices.size())});
    for (GpuVertex vertex : mesh.vertices) {
      const auto* weights = vertex.weights;
      if ((weights[0] | weights[1] | weights[2] | weights[3]) == 0) {
        vertex.joints[0] = static_cast<std::uint16_t>(input_.wardrobes[w].fixed_joint);
        vertex.weights[0] = 0xffff;
      }
      chunk.push_back(vertex);
    }
    packParts(w, id, std::span(chunk).last(mesh.vertices.size()));
    return *placed[id.value];
  }

  /// Writes each vertex's garment part above its first joint; the body is all part 0.
  void packParts(std::uint32_t w, MeshId id, std::span<GpuVertex> vertices) {
    std::vector<std::uint32_t> indices;
    for (const SubMesh& sub_mesh : lists(w).sub_meshes) {
      const IndexList& list = lists(w).index_lists[sub_mesh.list];
      if (list.mesh != id || sub_mesh.kind != SubMeshKind::kGarment) continue;
      indices.insert(indices.end(), list.indices.begin(), list.indices.end());
    }
    const std::vector<std::uint8_t> parts = garmentParts(vertices, indices);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      std::uint16_t& joint = vertices[i].joints[0];
      ENSEMBLE_CHECK(joint < (1u << ENSEMBLE_JOINT_BITS));
      joint = static_cast<std::uint16_t>(joint | parts[i] << ENSEMBLE_JOINT_BITS);
    }
  }

  /// The chunk that takes `count` more indices of a width: the last of that width, or a new one.
  std::uint32_t indexChunkFor(bool wide, std::size_t count) {
    for (std::size_t i = indices_.size(); i-- > 0;) {
      if (indices_[i].wide != wide) continue;
      const std::uint64_t index_bytes = indices_[i].indexBytes() + count * (wide ? 4 : 2);
      const std::uint64_t face_bytes = (indices_[i].source_faces.size() + count / 3) * 4;
      if (std::max(index_bytes, face_bytes) <= input_.limits.max_buffer_bytes)
        return static_cast<std::uint32_t>(i);
      break;
    }
    indices_.push_back({.wide = wide, .indices = {}, .source_faces = {}});
    return static_cast<std::uint32_t>(indices_.size() - 1);
  }

  PlacedList placeList(std::uint32_t w, IndexListId id) {
    auto& placed = numbers_[w].lists;
    placed.resize(lists(w).index_lists.size());
    if (placed[id.value]) return *placed[id.value];
    const IndexList& list = lists(w).index_lists[id];
    const PlacedMesh mesh = placeMesh(w, list.mesh);
    const bool wide = lists(w).meshes[list.mesh].wide_indices;
    checkSize(list.indices.size() * (wide ? 4 : 2), "an index list");
    const std::uint32_t chunk_number = indexChunkFor(wide, list.indices.size());
    OpenIndexChunk& chunk = indices_[chunk_number];
    placed[id.value] = PlacedList{.index_chunk = chunk_number,
                                  .vertex_chunk = mesh.chunk,
                                  .first_index = static_cast<std::uint32_t>(chunk.indices.size()),
                                  .first_face = static_cast<std::uint32_t>(chunk.source_faces.size()),
                                  .vertex_offset = mesh.vertex_offset,
                                  .mesh = mesh.number};
    chunk.indices.insert(chunk.indices.end(), list.indices.begin(), list.indices.end());
    chunk.source_faces.insert(chunk.source_faces.end(), list.source_faces.begin(), list.source_faces.end());
    return *placed[id.value];
  }

  /// Appends a material for one sub-mesh, unless the same one is there. What is of one material in an item
  /// has one tint, as jacket and trousers of a suit have; items that a person wears together are of different
  /// slots.
  std::uint32_t addMaterial(std::uint32_t w, const SubMesh& sub_mesh) {
    const ListMaterial& from = lists(w).materials[sub_mesh.material];
    GpuMaterial material = makeMaterial(w, sub_mesh);
    const bool is_body = sub_mesh.kind == SubMeshKind::kBody;
    const std::string name = is_body ? "" : toString(sub_mesh.slot);
    material.tint_key = tintKey(tintKindOf(from.material.name, from.is_skin),
                                name + "/" + tintedAs(w, sub_mesh).material.name);
    const auto same = [&](const GpuMaterial& other) {
      return std::memcmp(&other, &material, sizeof material) == 0;
    };
    const auto found = std::find_if(materials_.begin(), materials_.end(), same);
    if (found != materials_.end()) return static_cast<std::uint32_t>(found - materials_.begin());
    materials_.push_back(material);
    return static_cast<std::uint32_t>(materials_.size() - 1);
  }

  void addItems(std::uint32_t w, SubMeshKind kind) {
    const SubMeshLists& from = lists(w);
    for (std::uint32_t s = 0; s < from.sub_meshes.size(); ++s) {
      const SubMesh& sub_mesh = from.sub_meshes[SubMeshId(s)];
      if (sub_mesh.kind != kind) continue;
      const IndexList& list = from.index_lists[sub_mesh.list];
      const RawMaterial& material = from.materials[sub_mesh.material].material;
      const PlacedList placed = placeList(w, sub_mesh.list);
      const bool is_body = kind == SubMeshKind::kBody;
      DrawItem item;
      item.state = {
          .is_body = is_body,
          .double_sided = material.double_sided,
          .textured = material.image.has_value(),
          .cut_out = material.alpha_mode == AlphaMode::kMask,
          .hides_faces = sub_mesh.is_covered || (from.technique == Technique::kNaive && list.is_template),
          .texture_set = textureSet(w, material),
          .index_chunk = placed.index_chunk,
          .vertex_chunk = placed.vertex_chunk};
      item.first_index = placed.first_index;
      item.list = sub_mesh.list.value;
      item.index_count = static_cast<std::uint32_t>(list.indices.size());
      item.vertex_offset = placed.vertex_offset;
      item.mesh = placed.mesh;
      const std::uint32_t first_number =
          is_body ? 1 : assets_.first_garment_number_ + numbers_[w].first_garment;
      item.gpu = {.material = addMaterial(w, sub_mesh),
                  .region = first_number + sub_mesh.region,
                  .first_face = placed.first_face,
                  .face_offset = sub_mesh.source_face_offset,
                  .is_covered = sub_mesh.is_covered ? 1u : 0u};
      assets_.items_.push_back(item);
      origins_.emplace_back(w, s);
    }
  }

  std::uint32_t textureSet(std::uint32_t w, const RawMaterial& material) const {
    if (!material.image) return TextureStore::setIndex(0, true, true);
    const StoredTexture& texture = assets_.textures_->texture(numbers_[w].first_texture + *material.image);
    return TextureStore::setIndex(texture.size_class, material.repeat_u, material.repeat_v);
  }

  /// Draw order: by state, so that few calls draw all; inside a state as the lists have it.
  void sortItems() {
    std::vector<std::uint32_t> order(assets_.items_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return assets_.items_[a].state < assets_.items_[b].state;
    });
    std::vector<DrawItem> sorted;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
      sorted.push_back(assets_.items_[order[i]]);
      const auto [w, s] = origins_[order[i]];
      numbers_[w].item_of_sub_mesh.resize(lists(w).sub_meshes.size());
      numbers_[w].item_of_sub_mesh[s] = i;
    }
    assets_.items_ = std::move(sorted);
  }

  void addCombinations() {
    for (std::uint32_t w = 0; w < input_.wardrobes.size(); ++w) {
      numbers_[w].first_hidden_word = static_cast<std::uint32_t>(hidden_words_.size());
      for (const std::vector<std::uint32_t>& set : lists(w).hidden_sets) {
        hidden_words_.insert(hidden_words_.end(), set.begin(), set.end());
      }
    }
    for (const auto& [w, combination] : input_.combinations) {
      std::vector<SubMeshId> shown;
      for (const SubMeshId id : lists(w).shown[combination]) {
        shown.emplace_back(numbers_[w].item_of_sub_mesh[id.value]);
      }
      std::sort(shown.begin(), shown.end());
      assets_.shown_.push_back(std::move(shown));
      const std::uint32_t set = lists(w).hidden_set[combination];
      const auto words = static_cast<std::uint32_t>(lists(w).hidden_sets[set].size());  // alike in all
      hidden_first_.push_back(numbers_[w].first_hidden_word + set * words);
    }
  }

  void upload() {
    using Usage = vk::BufferUsageFlagBits;
    for (const std::vector<GpuVertex>& chunk : vertices_) {
      VertexChunk& uploaded = assets_.vertex_chunks_.emplace_back();
      uploaded.vertices = gpu::uploadBuffer(
          device_, bytesOf(chunk), Usage::eVertexBuffer | Usage::eUniformTexelBuffer, "a buffer of vertices");
      uploaded.texels = uploaded.vertices.makeTexelView(device_, vk::Format::eR32G32Uint);
    }
    for (const OpenIndexChunk& chunk : indices_) assets_.index_chunks_.push_back(uploadIndices(chunk));
    checkSize(hidden_words_.size() * 4, "the table of hidden faces");
    checkSize(materials_.size() * sizeof(GpuMaterial), "the table of materials");
    constexpr auto storage = Usage::eStorageBuffer | Usage::eUniformTexelBuffer;
    assets_.materials_ = gpu::uploadBuffer(device_, bytesOf(materials_), storage, "the materials");
    assets_.tints_ = gpu::uploadBuffer(device_, bytesOf(tintTable()), storage, "the tints");
    assets_.hidden_first_ = gpu::uploadBuffer(device_, bytesOf(hidden_first_), storage, "the hidden faces");
    assets_.hidden_words_ = gpu::uploadBuffer(device_, bytesOf(hidden_words_), storage, "the hidden faces");
  }

  IndexChunk uploadIndices(const OpenIndexChunk& from) {
    using Usage = vk::BufferUsageFlagBits;
    constexpr auto usage = Usage::eIndexBuffer | Usage::eUniformTexelBuffer;
    IndexChunk chunk;
    chunk.type = from.wide ? vk::IndexType::eUint32 : vk::IndexType::eUint16;
    if (from.wide) {
      chunk.indices = gpu::uploadBuffer(device_, bytesOf(from.indices), usage, "a buffer of indices");
    } else {
      std::vector<std::uint16_t> narrow;
      narrow.reserve(from.indices.size());
      for (const std::uint32_t index : from.indices) {
        ENSEMBLE_CHECK(index <= 0xffffu);
        narrow.push_back(static_cast<std::uint16_t>(index));
      }
      if (narrow.size() % 2 != 0) narrow.push_back(0);  // to whole words
      chunk.indices = gpu::uploadBuffer(device_, bytesOf(narrow), usage, "a buffer of indices");
    }
    chunk.texels = chunk.indices.makeTexelView(device_, vk::Format::eR32Uint);
    chunk.source_faces = gpu::uploadBuffer(device_, bytesOf(from.source_faces), Usage::eStorageBuffer,
                                           "the table of source faces");
    return chunk;
  }

  /// Where a wardrobe's things begin or went.
  struct Numbers {
    std::size_t first_texture = 0;
    std::uint32_t first_garment = 0;
    std::uint32_t first_hidden_word = 0;
    std::vector<std::optional<PlacedMesh>> meshes;
    std::vector<std::optional<PlacedList>> lists;
    std::vector<std::uint32_t> item_of_sub_mesh;
  };

  CrowdAssets& assets_;
  gpu::Device& device_;
  const Input& input_;
  std::vector<Numbers> numbers_;
  std::uint32_t garment_count_ = 0;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> origins_;  // per item: wardrobe, sub-mesh
  std::vector<std::vector<GpuVertex>> vertices_;
  std::vector<OpenIndexChunk> indices_;
  std::vector<GpuMaterial> materials_;
  std::vector<std::uint32_t> hidden_first_, hidden_words_;
};

CrowdAssets::CrowdAssets(gpu::Device& device, const Input& input) { Builder(*this, device, input).build(); }

}  // namespace ensemble
