#include "assetpipe/make_people.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <system_error>
#include <utility>

#include "assetpipe/people_body.h"
#include "assetpipe/people_clips.h"
#include "assetpipe/people_garments.h"
#include "assetpipe/people_skin.h"
#include "assetpipe/surface_check.h"
#include "core/atomic_file.h"
#include "core/check.h"
#include "core/clip.h"
#include "core/gltf_file.h"
#include "core/input_error.h"
#include "core/parallel.h"

namespace ensemble {
namespace {

/// A vertex as a face of a region has it: the head has texture coordinates of its own, with a seam.
RawVertex vertexOf(const Figure& figure, RawVertex vertex, std::uint32_t region, bool right) {
  if (region == static_cast<std::uint32_t>(BodyRegion::kHead))
    vertex.uv = headUv(figure, vertex.position, right);
  return vertex;
}

/// The body as one primitive a region, in the order of the regions; hidden faces left out.
RawMeshNode bodyNode(const Figure& figure, const FieldMesh& mesh, const std::vector<RawVertex>& vertices,
                     const std::vector<std::uint8_t>& hidden) {
  RawMeshNode node;
  node.name = "body";
  for (std::uint32_t region = 0; region < kBodyRegionCount; ++region) {
    RawPrimitive primitive;
    primitive.material = region;
    // By vertex: its number where the head's two halves agree about it, and on the right side of the seam.
    std::vector<std::uint32_t> renumbered(2 * vertices.size(), ~0u);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (mesh.labels[f] != region || hidden[f] != 0) continue;
      Triangle face = mesh.faces[f];
      float side = 0.0f;
      for (const std::uint32_t v : face) side += vertices[v].position.x;
      for (std::uint32_t& v : face) {
        const RawVertex vertex = vertexOf(figure, vertices[v], region, side < 0.0f);
        const bool has_two = vertex != vertexOf(figure, vertices[v], region, false);
        std::uint32_t& number = renumbered[2 * v + (has_two ? 1 : 0)];
        if (number == ~0u) {
          number = static_cast<std::uint32_t>(primitive.vertices.size());
          primitive.vertices.push_back(vertex);
        }
        v = number;
      }
      primitive.faces.push_back(face);
    }
    if (!primitive.faces.empty()) node.primitives.push_back(std::move(primitive));
  }
  return node;
}

/// The regions' materials; the head's colours are all in its texture, image 0.
std::vector<RawMaterial> skinMaterials(const Vec3& skin) {
  std::vector<RawMaterial> materials;
  for (const char* region : kBodyRegionNames) {
    RawMaterial material;
    material.name = region;
    material.base_color = Vec4(skin, 1.0f);
    materials.push_back(std::move(material));
  }
  RawMaterial& head = materials[static_cast<std::size_t>(BodyRegion::kHead)];
  head.base_color = Vec4(1.0f);
  head.image = 0;
  return materials;
}

/// Makes the parts of one person that its files share.
class PersonMaker {
 public:
  explicit PersonMaker(const PersonConfig& config)
      : config_(config),
        figure_(makeFigure(config.figure)),
        skeleton_(makeSkeleton(figure_)),
        mesh_(makeBodyMesh(figure_, config.body_faces)),
        head_(paintHead(figure_, config.colors)) {
    requireSoundBody(config.name, mesh_);
    const Field body = [this](const Vec3& p) { return figure_.body(p); };
    for (const Vec3& p : mesh_.positions) {
      vertices_.push_back(makeVertex(figure_, body, p, bodyBinding(figure_, p)));
    }
    nothing_hidden_.assign(mesh_.faces.size(), 0);
  }
  PersonMaker(const PersonMaker&) = delete;
  PersonMaker& operator=(const PersonMaker&) = delete;

  RawAsset makeTemplate() const {
    RawAsset body = asset(bodyNode(figure_, mesh_, vertices_, nothing_hidden_), {});
    for (const Clip& clip : makeClips(figure_, skeleton_)) body.clips.push_back(toRawClip(skeleton_, clip));
    return body;
  }

  MadePerson run(unsigned jobs) {
    MadePerson person;
    person.name = config_.name;
    person.body = makeTemplate();
    person.walk_speed = walkSpeed(figure_);
    person.run_speed = runSpeed(figure_);
    std::vector<OutfitPlan> plans = outfitPlans(config_.figure.sex);
    std::erase_if(plans, [this](const OutfitPlan& plan) {
      return !config_.outfits.empty() &&
             std::find(config_.outfits.begin(), config_.outfits.end(), plan.name) == config_.outfits.end();
    });
    makeGarments(plans, jobs);
    for (const OutfitPlan& plan : plans) person.outfits.push_back(dress(plan));
    return person;
  }

 private:
  /// Makes each garment of the plans once, several at a time.
  void makeGarments(const std::vector<OutfitPlan>& plans, unsigned jobs) {
    for (const OutfitPlan& plan : plans) {
      for (const std::string& name : plan.garments) garments_.try_emplace(name);
    }
    std::vector<std::pair<const std::string, MadeGarment>*> entries;
    for (auto& entry : garments_) entries.push_back(&entry);
    forEachOnThreads(threadCount(jobs), entries.size(), [&](std::size_t i) {
      entries[i]->second =
          makeGarment(figure_, designGarment(figure_, config_.colors, config_.seed, entries[i]->first));
    });
  }

  MadeOutfit dress(const OutfitPlan& plan) const {
    std::vector<const MadeGarment*> garments;
    for (const std::string& name : plan.garments) garments.push_back(&garments_.at(name));
    const std::vector<std::uint8_t> hidden = findCoveredFaces(mesh_, garments);
    MadeOutfit outfit;
    outfit.name = plan.name;
    outfit.fitted = asset(bodyNode(figure_, mesh_, vertices_, hidden), garments);
    outfit.unfitted = asset(bodyNode(figure_, mesh_, vertices_, nothing_hidden_), garments);
    return outfit;
  }

  RawAsset asset(RawMeshNode body, const std::vector<const MadeGarment*>& garments) const {
    RawAsset asset;
    asset.copyright = "Made by ensemble people";
    asset.skeleton = skeleton_;
    asset.materials = skinMaterials(config_.colors.skin);
    asset.images = {head_};
    asset.meshes.push_back(std::move(body));
    for (const MadeGarment* garment : garments) {
      RawMeshNode node = garment->node;
      for (RawPrimitive& primitive : node.primitives) {
        primitive.material += static_cast<std::uint32_t>(asset.materials.size());
      }
      asset.materials.insert(asset.materials.end(), garment->materials.begin(), garment->materials.end());
      asset.meshes.push_back(std::move(node));
    }
    return asset;
  }

  const PersonConfig& config_;
  const Figure figure_;
  const RawSkeleton skeleton_;
  const FieldMesh mesh_;
  const RawImage head_;
  std::vector<RawVertex> vertices_;
  std::vector<std::uint8_t> nothing_hidden_;
  std::map<std::string, MadeGarment> garments_;
};

}  // namespace

void requireSoundBody(const std::string& person, const FieldMesh& mesh) {
  const SurfaceCheck check = checkSurface(mesh.positions, mesh.faces);
  ENSEMBLE_CHECK(check.is_manifold && check.is_closed && check.faces_outwards);
  if (check.crossings.empty()) return;
  const Vec3 at = check.crossings.front();
  throw InputError({"", fmt::format("person '{}'", person),
                    fmt::format("a body of {} faces cuts itself at ({:.2f}, {:.2f}, {:.2f})",
                                mesh.faces.size(), at.x, at.y, at.z),
                    "give it more faces, or less extreme measures"});
}

MadePerson makePerson(const PersonConfig& config, unsigned jobs) { return PersonMaker(config).run(jobs); }
RawAsset makeTemplatePerson(const PersonConfig& config) { return PersonMaker(config).makeTemplate(); }

std::vector<std::filesystem::path> writePerson(const MadePerson& person,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path own = folder / person.name;
  for (const char* part : {"outfits", "unfitted"}) {
    std::error_code error;
    std::filesystem::create_directories(own / part, error);
    if (error)
      throw SystemError({(own / part).string(), "", "the folder can't be made: " + error.message(), ""});
  }
  const auto write = [&](const std::filesystem::path& file, const RawAsset& asset) {
    writeFileAtomically(file, writeGlb(asset));
    files.push_back(file);
  };
  write(own / "template.glb", person.body);
  for (const MadeOutfit& outfit : person.outfits) {
    write(own / "outfits" / (outfit.name + ".glb"), outfit.fitted);
    write(own / "unfitted" / (outfit.name + ".glb"), outfit.unfitted);
  }
  return files;
}

}  // namespace ensemble
