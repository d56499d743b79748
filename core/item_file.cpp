// outfits/NAME.HHHHHHHHHHHH.glb: one item, complete in itself (Lister section 6: what is
// downloaded for a new outfit is clothing, replacement sub-meshes and metadata).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/check.h"
#include "core/input_error.h"
#include "core/nearest_name.h"
#include "core/wardrobe_files.h"

namespace ensemble {
namespace {

using nlohmann::json;

constexpr const char* kItemSchema = "ensemble.outfit/1";
constexpr const char* kMend = "tag the outfit again with `ensemble tag`";

/// The same face whichever corner stands first.
Triangle rotatedToSmallest(const Triangle& face) {
  if (face[0] <= face[1] && face[0] <= face[2]) return face;
  if (face[1] <= face[0] && face[1] <= face[2]) return {face[1], face[2], face[0]};
  return {face[2], face[0], face[1]};
}

/// The visible faces of a body part as a small primitive whose vertices know their template vertex.
RawPrimitive partialPrimitive(const TemplateBody& body, const BodyPart& part,
                              const PerFace<std::uint8_t>& visible) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> renumbered(body.vertices.size(), kUnused);
  RawPrimitive primitive;
  for (std::uint32_t f = part.first_face; f < part.first_face + part.face_count; ++f) {
    if (visible[FaceId(f)] == 0) continue;
    Triangle corners = body.faces[FaceId(f)];
    for (std::uint32_t& vertex : corners) {
      std::uint32_t& number = renumbered[vertex];
      if (number == kUnused) {
        number = static_cast<std::uint32_t>(primitive.vertices.size());
        primitive.vertices.push_back(body.vertices[VertexId(vertex)]);
        primitive.template_vertices.push_back(vertex);
      }
      vertex = number;
    }
    primitive.faces.push_back(corners);
  }
  return primitive;
}

/// Adds an item's materials (or the template's) to a file and tells where they went.
std::uint32_t addMaterial(RawAsset& asset, RawMaterial material, const std::vector<RawImage>& images) {
  if (material.image) {
    const RawImage& image = images[*material.image];
    const auto found = std::find(asset.images.begin(), asset.images.end(), image);
    material.image = static_cast<std::uint32_t>(found - asset.images.begin());
    if (found == asset.images.end()) asset.images.push_back(image);
  }
  const auto found = std::find(asset.materials.begin(), asset.materials.end(), material);
  const auto index = static_cast<std::uint32_t>(found - asset.materials.begin());
  if (found == asset.materials.end()) asset.materials.push_back(std::move(material));
  return index;
}

json itemExtras(const Item& item, const TemplateBody& body, const std::string& geometry_hash) {
  const ManifestOutfit entry = manifestEntry(item, body, "", "");
  json garments = json::array(), regions = json::array(), extra = json::array();
  for (std::size_t g = 0; g < entry.garments.size(); ++g) {
    garments.push_back({{"name", entry.garments[g].name},
                        {"faces", entry.garments[g].faces},
                        {"primitives", item.garments[g].parts.size()}});
  }
  for (const ManifestTag& tag : entry.regions) {
    regions.push_back({{"name", tag.name},
                       {"visibility", toString(tag.visibility)},
                       {"template_faces", tag.template_faces},
                       {"visible_faces", tag.visible_faces}});
  }
  for (const ExtraBodyPart& part : item.extra_body) extra.push_back(body.regions[part.region].name);
  return {{"schema", kItemSchema},
          {"name", item.name},
          {"slot", toString(item.slot)},
          {"layer", item.layer},
          {"template", {{"geometry_hash", geometry_hash}, {"faces", body.faces.size()}}},
          {"garments", std::move(garments)},
          {"regions", std::move(regions)},
          {"extra_body_regions", std::move(extra)}};
}

json ensembleExtras(const RawAsset& asset) {
  const json extras = json::parse(asset.extras_json, nullptr, false);
  if (!extras.is_object()) return {};
  return extras.value("ensemble", json());
}

/// Reads an item back, checking everything that its extras claim.
class ItemReader {
 public:
  ItemReader(const RawAsset& asset, const TemplateBody& body, const std::string& file)
      : asset_(asset), body_(body), file_(file), extras_(ensembleExtras(asset)) {}

  Item read(const std::string& geometry_hash) {
    checkTemplate(geometry_hash);
    item_.name = text("name");
    const std::string slot = text("slot");
    item_.layer = static_cast<int>(number(extras_, "layer", "/layer"));
    if (!isValidItemName(item_.name)) fail("/name", "'" + item_.name + "' can't be an outfit's name");
    const std::optional<Slot> known_slot = parseSlot(slot);
    if (!known_slot) fail("/slot", quotedName(slot) + " is no slot: not " + slotNames());
    item_.slot = *known_slot;
    if (item_.layer < -1000 || item_.layer > 1000) fail("/layer", "the layer is out of range");
    item_.materials = asset_.materials;
    item_.images = asset_.images;
    readGarments();
    readTags();
    readBody();
    readExtraBody();
    checkCounts();
    if (next_mesh_ != asset_.meshes.size()) fail("", "there are more meshes than garments and body");
    return std::move(item_);
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what) const {
    throw InputError({file_, "/extras/ensemble" + where, what, kMend});
  }

  std::string text(const char* key) const {
    const json value = extras_.value(key, json());
    if (!value.is_string()) fail(std::string("/") + key, "a text is missing");
    return value;
  }

  double number(const json& node, const char* key, const std::string& where) const {
    const json value = node.is_object() ? node.value(key, json()) : json();
    if (!value.is_number_integer()) fail(where, "a whole number is missing");
    return value;
  }

  json list(const char* key) const {
    json value = extras_.value(key, json());
    if (!value.is_array()) fail(std::string("/") + key, "a list is missing");
    return value;
  }

  void checkTemplate(const std::string& geometry_hash) const {
    const json tagged_for = extras_.value("template", json());
    const json hash = tagged_for.is_object() ? tagged_for.value("geometry_hash", json()) : json();
    if (hash == geometry_hash) return;
    throw InputError({file_, "/extras/ensemble/template/geometry_hash",
                      "this outfit was tagged for another template, its classes don't hold here",
                      "tag the raw outfit for this template"});
  }

  const RawMeshNode& nextMesh() {
    if (next_mesh_ >= asset_.meshes.size()) fail("", "a mesh is missing");
    return asset_.meshes[next_mesh_++];
  }

  void readGarments() {
    for (const json& garment : list("garments")) {
      const json name = garment.is_object() ? garment.value("name", json()) : json();
      if (!name.is_string() || name == "") fail("/garments", "a garment has no name");
      const RawMeshNode& node = nextMesh();
      std::size_t faces = 0;
      for (const RawPrimitive& part : node.primitives) faces += part.faces.size();
      if (number(garment, "faces", "/garments") != static_cast<double>(faces)) {
        fail("/garments", "garment '" + name.get<std::string>() + "' has another number of faces");
      }
      item_.garments.push_back({name, node.primitives});
    }
  }

  void readTags() {
    const json tags = list("regions");
    if (tags.size() != body_.regions.size()) fail("/regions", "another number of regions than the template");
    item_.visible.assign(body_.faces.size(), 0);
    for (std::size_t r = 0; r < tags.size(); ++r) {
      const Region& region = body_.regions[RegionId(r)];
      const json& tag = tags[r];
      const json visibility = tag.is_object() ? tag.value("visibility", json()) : json();
      RegionTag read;
      if (visibility == "full") {
        read.visibility = Visibility::kFull;
      } else if (visibility == "partial") {
        read.visibility = Visibility::kPartial;
      } else if (visibility == "hidden") {
        read.visibility = Visibility::kHidden;
      } else {
        fail("/regions", "region '" + region.name + "' has no class");
      }
      if (tag.value("name", json()) != region.name) fail("/regions", "the regions are not the template's");
      const double faces = number(tag, "visible_faces", "/regions");
      if (!(faces >= 0 && faces <= 4294967295.0)) fail("/regions", "a count is out of range");
      read.visible_faces = static_cast<std::uint32_t>(faces);
      if (read.visibility == Visibility::kFull) {
        std::fill_n(item_.visible.begin() + region.first_face, region.face_count, std::uint8_t{1});
      }
      item_.tags.push(read);
    }
  }

  /// Partial regions: each primitive's faces are found among the template's by vertex numbers.
  void readBody() {
    bool any_partial = false;
    for (const RegionTag& tag : item_.tags)
      any_partial = any_partial || tag.visibility == Visibility::kPartial;
    const bool has_body = next_mesh_ < asset_.meshes.size() &&
                          !asset_.meshes[next_mesh_].primitives.front().template_vertices.empty();
    if (!any_partial || !has_body) return;

    PerRegion<std::vector<FaceFinder>> finders(body_.regions.size());
    for (const RawPrimitive& primitive : nextMesh().primitives) {
      if (primitive.template_vertices.empty()) fail("", "a body primitive lacks _TEMPLATE_VERTEX");
      for (const Triangle& face : primitive.faces) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = primitive.template_vertices[face[k]];
          if (corners[k] >= body_.vertices.size()) fail("", "_TEMPLATE_VERTEX is out of range");
        }
        const RegionId region = regionOfVertex(corners[0]);
        if (finders[region].empty()) finders[region].emplace_back(body_, body_.regions[region]);
        const FaceId found = finders[region].front().take(corners);
        if (!found.valid() || item_.tags[region].visibility != Visibility::kPartial) {
          fail("", "a body face is not a face of a partial region of the template");
        }
        item_.visible[found] = 1;
      }
    }
  }

  RegionId regionOfVertex(std::uint32_t vertex) const {
    for (std::size_t r = 0; r < body_.regions.size(); ++r) {
      const Region& region = body_.regions[RegionId(r)];
      if (vertex >= region.first_vertex && vertex - region.first_vertex < region.vertex_count)
        return RegionId(r);
    }
    fail("", "_TEMPLATE_VERTEX is out of range");
  }

  void readExtraBody() {
    const json regions = list("extra_body_regions");
    if (regions.empty()) return;
    const RawMeshNode& node = nextMesh();
    if (node.primitives.size() != regions.size()) fail("/extra_body_regions", "another number of primitives");
    for (std::size_t p = 0; p < regions.size(); ++p) {
      RegionId region;
      for (std::size_t r = 0; r < body_.regions.size(); ++r) {
        if (regions[p] == body_.regions[RegionId(r)].name) region = RegionId(r);
      }
      if (!region.valid()) fail("/extra_body_regions", "the template has no such region");
      item_.extra_body.push_back({region, node.primitives[p]});
    }
  }

  void checkCounts() const {
    PerRegion<std::uint32_t> visible(body_.regions.size(), 0);
    for (std::size_t f = 0; f < body_.faces.size(); ++f) {
      visible[body_.region_of_face[FaceId(f)]] += item_.visible[FaceId(f)];
    }
    for (const ExtraBodyPart& extra : item_.extra_body) {
      visible[extra.region] += static_cast<std::uint32_t>(extra.part.faces.size());
    }
    for (std::size_t r = 0; r < visible.size(); ++r) {
      if (visible[RegionId(r)] == item_.tags[RegionId(r)].visible_faces) continue;
      fail("/regions", "region '" + body_.regions[RegionId(r)].name + "' claims " +
                           std::to_string(item_.tags[RegionId(r)].visible_faces) +
                           " visible faces but shows " + std::to_string(visible[RegionId(r)]));
    }
  }

  const RawAsset& asset_;
  const TemplateBody& body_;
  const std::string& file_;
  json extras_;
  Item item_;
  std::size_t next_mesh_ = 0;
};

}  // namespace

FaceFinder::FaceFinder(const TemplateBody& body, const Region& region) {
  for (std::uint32_t f = region.first_face; f < region.first_face + region.face_count; ++f) {
    entries_.push_back({rotatedToSmallest(body.faces[FaceId(f)]), FaceId(f), false});
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.face < b.face;
  });
}

FaceId FaceFinder::take(const Triangle& template_vertices) {
  const Triangle corners = rotatedToSmallest(template_vertices);
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), corners,
                                [](const Entry& a, const Triangle& b) { return a.corners < b; });
  while (entry != entries_.end() && entry->corners == corners && entry->taken) ++entry;
  if (entry == entries_.end() || entry->corners != corners) return FaceId::none();
  entry->taken = true;
  return entry->face;
}

RawAsset assetFromItem(const Item& item, const TemplateBody& body, const std::string& geometry_hash) {
  ENSEMBLE_CHECK(item.visible.size() == body.faces.size());
  RawAsset asset;
  asset.skeleton = body.skeleton;
  for (const Garment& garment : item.garments) {
    RawMeshNode node{garment.name, "", true, garment.parts};
    for (RawPrimitive& part : node.primitives) {
      part.material = addMaterial(asset, item.materials[part.material], item.images);
    }
    asset.meshes.push_back(std::move(node));
  }

  RawMeshNode partial{"body", "", true, {}};
  for (const BodyPart& part : body.parts) {
    if (item.tags[part.region].visibility != Visibility::kPartial) continue;
    RawPrimitive primitive = partialPrimitive(body, part, item.visible);
    if (primitive.faces.empty()) continue;
    primitive.material = addMaterial(asset, body.materials[part.material], body.images);
    partial.primitives.push_back(std::move(primitive));
  }
  if (!partial.primitives.empty()) asset.meshes.push_back(std::move(partial));

  RawMeshNode extra{"body.extra", "", true, {}};
  for (const ExtraBodyPart& part : item.extra_body) {
    extra.primitives.push_back(part.part);
    extra.primitives.back().material = addMaterial(asset, item.materials[part.part.material], item.images);
  }
  if (!extra.primitives.empty()) asset.meshes.push_back(std::move(extra));
  asset.extras_json = json{{"ensemble", itemExtras(item, body, geometry_hash)}}.dump();
  return asset;
}

bool isTaggedItem(const RawAsset& asset) {
  const json extras = ensembleExtras(asset);
  return extras.is_object() && extras.value("schema", json()) == kItemSchema;
}

Item itemFromAsset(const RawAsset& asset, const TemplateBody& body, const std::string& geometry_hash,
                   const std::string& file) {
  return ItemReader(asset, body, file).read(geometry_hash);
}

}  // namespace ensemble
