#include "assetpipe/make_people.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

#include "assetpipe/built_in_recipes.h"
#include "assetpipe/people_body.h"
#include "assetpipe/people_clips.h"
#include "assetpipe/segment.h"
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

/// The body as one primitive a region, in the order of the regions.
RawMeshNode bodyNode(const Figure& figure, const FieldMesh& mesh, const std::vector<RawVertex>& vertices) {
  RawMeshNode node;
  node.name = "body";
  for (std::uint32_t region = 0; region < kBodyRegionCount; ++region) {
    RawPrimitive primitive;
    primitive.material = region;
    // By vertex: its number where the head's two halves agree about it, and on the right side of the seam.
    std::vector<std::uint32_t> renumbered(2 * vertices.size(), ~0u);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      if (mesh.labels[f] != region) continue;
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

/// Hair grows in the person's colour, whatever the recipe says.
void colorHair(const Vec3& color, RawAsset& outfit) {
  for (RawMaterial& material : outfit.materials) {
    if (material.name.starts_with("hair.") && !material.image) material.base_color = Vec4(color, 1.0f);
  }
}

/// Dresses a template by several recipes at a time.
class Dresser {
 public:
  /// @param body the template; read back from its file's bytes, so that outfits are those of `ensemble
  /// author`
  Dresser(const RawAsset& body, const std::string& name)
      : asset_(readGlb(writeGlb(body), name)), segmented_(segmentTemplate(asset_, {}, name, warnings_)) {}

  std::vector<MadeOutfit> run(const std::vector<Recipe>& recipes, unsigned jobs) const {
    std::vector<MadeOutfit> outfits(recipes.size());
    const unsigned threads = threadCount(jobs);
    std::vector<std::optional<AuthorBody>> measured(threads);  // one body is for one thread alone
    forEachOnThreads(threads, recipes.size(), [&](std::size_t i, unsigned thread) {
      if (!measured[thread]) measured[thread].emplace(segmented_);
      outfits[i] = {recipes[i], authorOutfit(recipes[i], asset_, *measured[thread])};
    });
    return outfits;
  }

 private:
  std::vector<std::string> warnings_;
  const RawAsset asset_;
  const TemplateBody segmented_;
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

namespace {

RawAsset makeTemplate(const PersonConfig& config, const Figure& figure) {
  const FieldMesh mesh = makeBodyMesh(figure, config.body_faces);
  requireSoundBody(config.name, mesh);
  const Field body = [&figure](const Vec3& p) { return figure.body(p); };
  std::vector<RawVertex> vertices;
  for (const Vec3& p : mesh.positions)
    vertices.push_back(makeVertex(figure, body, p, bodyBinding(figure, p)));
  RawAsset asset;
  asset.copyright = "Made by ensemble people";
  asset.skeleton = makeSkeleton(figure);
  asset.materials = skinMaterials(config.colors.skin);
  asset.images = {paintHead(figure, config.colors)};
  asset.meshes.push_back(bodyNode(figure, mesh, vertices));
  for (const Clip& clip : makeClips(figure, asset.skeleton))
    asset.clips.push_back(toRawClip(asset.skeleton, clip));
  return asset;
}

}  // namespace

RawAsset makeTemplatePerson(const PersonConfig& config) {
  return makeTemplate(config, makeFigure(config.figure));
}

MadePerson makePerson(const PersonConfig& config, unsigned jobs) {
  MadePerson person;
  person.name = config.name;
  const Figure figure = makeFigure(config.figure);
  person.body = makeTemplate(config, figure);
  person.walk_speed = walkSpeed(figure);
  person.run_speed = runSpeed(figure);
  std::vector<Recipe> recipes;
  for (const std::string& name : config.outfits.empty() ? builtInRecipeNames() : config.outfits)
    recipes.push_back(builtInRecipe(name));
  person.outfits = Dresser(person.body, config.name).run(recipes, jobs);
  for (MadeOutfit& made : person.outfits) colorHair(config.colors.hair, made.outfit.asset);
  return person;
}

std::vector<std::filesystem::path> writePerson(const MadePerson& person,
                                               const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::path own = folder / person.name;
  std::error_code error;
  std::filesystem::create_directories(own / "outfits", error);
  if (error)
    throw SystemError({(own / "outfits").string(), "", "the folder can't be made: " + error.message(), ""});
  const auto write = [&](const std::filesystem::path& file, const RawAsset& asset) {
    writeFileAtomically(file, writeGlb(asset));
    files.push_back(file);
  };
  write(own / "template.glb", person.body);
  for (const MadeOutfit& made : person.outfits)
    write(own / "outfits" / (made.recipe.name + ".glb"), made.outfit.asset);
  return files;
}

}  // namespace ensemble
