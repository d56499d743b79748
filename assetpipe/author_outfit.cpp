#include "assetpipe/author_outfit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "assetpipe/cloth_mesh.h"
#include "assetpipe/cloth_pattern.h"
#include "core/atomic_file.h"
#include "core/color.h"
#include "core/image_file.h"
#include "core/input_error.h"
#include "core/nearest_name.h"

namespace ensemble {
namespace {

[[noreturn]] void failAt(const Recipe& recipe, const SourceMark& mark, const std::string& what,
                         const std::string& mend) {
  throw InputError({recipe.file.string(), mark.toString(), what, mend});
}

std::vector<std::string> jointNames(const RawSkeleton& skeleton) {
  std::vector<std::string> names;
  for (const RawJoint& joint : skeleton.joints) names.push_back(skeleton.bones[joint.bone].name);
  return names;
}

std::string didYouMean(const std::string& name, const std::vector<std::string>& known) {
  return "did you mean " + quotedList(nearestNames(name, known)) + "?";
}

void checkNamedJoints(const Recipe& recipe, const RawSkeleton& skeleton) {
  const std::vector<std::string> names = jointNames(skeleton);
  for (const auto& [landmark, joint] : recipe.joints) {
    if (findJoint(skeleton, joint)) continue;
    failAt(recipe, recipe.joint_marks.at(landmark), "the template has no joint '" + joint + "'",
           didYouMean(joint, names));
  }
}

void checkGarment(const Recipe& recipe, const GarmentRecipe& garment, const AuthorBody& body,
                  const Landmarks& marks) {
  const RawSkeleton& skeleton = body.body().skeleton;
  for (const Landmark mark : requiredLandmarks(garment)) {
    if (marks.has(mark)) continue;
    failAt(recipe, garment.mark,
           fmt::format("garment '{}' needs the {}, for which the template has no joint ('{}', for example)",
                       garment.name, landmarkNames()[static_cast<std::size_t>(mark)],
                       Landmarks::usualName(mark)),
           "name the joint under joints, or dress another template");
  }
  if (garment.attach && !findJoint(skeleton, garment.attach->value)) {
    failAt(recipe, garment.attach->mark, "the template has no joint '" + garment.attach->value + "'",
           didYouMean(garment.attach->value, jointNames(skeleton)));
  }
  if (!garment.avoid) return;
  std::vector<std::string> regions;
  for (const Region& region : body.body().regions) regions.push_back(region.name);
  if (std::find(regions.begin(), regions.end(), garment.avoid->value) == regions.end()) {
    failAt(recipe, garment.avoid->mark, "the template has no region '" + garment.avoid->value + "'",
           "name one of " + quotedList(regions));
  }
}

RawMaterial makeMaterial(const std::string& name, const Vec3& srgb) {
  RawMaterial material;
  material.name = name;
  material.base_color = Vec4(linearFromSrgb(srgb), 1.0f);
  material.double_sided = true;
  return material;
}

RawImage readTexture(const GarmentRecipe& garment) {
  RawImage image;
  image.name = garment.name;
  image.bytes = readFile(garment.texture, 1u << 26);
  readImageHeader(image.bytes, garment.texture.string(), "", image);
  decodeImage(image, garment.texture.string());
  return image;
}

/// The plain material that an earlier garment of the outfit is made of, or none. What is of one cloth shares
/// it, so that jacket and trousers of a suit are tinted alike.
std::optional<std::uint32_t> sameCloth(const std::vector<RawMaterial>& materials,
                                       const std::vector<std::uint32_t>& mains, const RawMaterial& wanted) {
  const auto kind = [](const RawMaterial& material) {
    return material.name.substr(0, material.name.find('.'));
  };
  for (const std::uint32_t main : mains) {
    const RawMaterial& known = materials[main];
    if (!known.image && !wanted.image && known.base_color == wanted.base_color && kind(known) == kind(wanted))
      return main;
  }
  return std::nullopt;
}

/// Materials by label: the cloth's, then the trims'.
std::vector<RawMaterial> makeMaterials(const GarmentRecipe& garment, std::vector<RawImage>& images) {
  const std::string name = garment.material + "." + garment.name;
  std::vector<RawMaterial> materials = {makeMaterial(name, garment.color)};
  if (garment.pattern.kind != PatternKind::kNone || !garment.texture.empty()) {
    materials[0].image = static_cast<std::uint32_t>(images.size());
    materials[0].base_color = Vec4(1.0f);
    images.push_back(garment.texture.empty() ? patternImage(garment.name, garment.color, garment.pattern)
                                             : readTexture(garment));
  }
  for (const TrimRecipe& trim : garment.trims) {
    const std::string& kind = trim.material.empty() ? garment.material : trim.material;
    materials.push_back(makeMaterial(kind + "." + garment.name + "." + trim.name, trim.color));
  }
  return materials;
}

GarmentFigures figuresOf(const GarmentRecipe& garment, const FieldMesh& mesh, const RawMeshNode& node,
                         const BodySurface& surface) {
  GarmentFigures figures;
  figures.name = garment.name;
  for (const RawPrimitive& primitive : node.primitives) {
    figures.faces += primitive.faces.size();
    figures.vertices += primitive.vertices.size();
  }
  figures.least_distance = std::numeric_limits<float>::max();
  double sum = 0.0;
  for (const Vec3& p : mesh.positions) {
    const float distance = surface.signedDistance(p);
    figures.least_distance = std::min(figures.least_distance, distance);
    figures.greatest_distance = std::max(figures.greatest_distance, distance);
    sum += distance;
  }
  figures.mean_distance = static_cast<float>(sum / static_cast<double>(mesh.positions.size()));
  figures.pokes = countPokes(mesh, surface, kPokeTolerance);
  return figures;
}

/// Of the last garment, where it and the body cross.
void warnAbout(const Recipe& recipe, AuthoredOutfit& outfit) {
  const GarmentFigures& garment = outfit.garments.back();
  const std::size_t left = garment.pokes.cloth_in_body + garment.pokes.body_in_front;
  if (left == 0) return;
  outfit.warnings.push_back(
      fmt::format("{}: garment '{}' and the body still cross at {} vertices; give it more ease",
                  recipe.file.string(), garment.name, left));
}

}  // namespace

AuthoredOutfit authorOutfit(const Recipe& recipe, const RawAsset& asset, const AuthorBody& body) {
  checkNamedJoints(recipe, body.body().skeleton);
  const Landmarks marks(body.body().skeleton, recipe.joints);
  for (const GarmentRecipe& garment : recipe.garments) checkGarment(recipe, garment, body, marks);
  AuthoredOutfit outfit;
  outfit.asset = asset;
  outfit.asset.clips.clear();
  outfit.asset.extras_json.clear();
  outfit.asset.dropped.clear();
  outfit.asset.warnings.clear();
  outfit.asset.scene_extras_json =
      nlohmann::ordered_json({{"ensemble", {{"slot", toString(recipe.slot)}, {"layer", recipe.layer}}}})
          .dump();
  const TailorFrame frame(body, marks);
  std::vector<ClothPiece> below;
  std::vector<std::uint32_t> mains;  // the cloth's own materials so far
  for (const GarmentRecipe& garment : recipe.garments) {
    ClothPiece cloth = meshCloth(frame, garment, designCloth(frame, garment), below);
    if (cloth.mesh.faces.empty()) {
      failAt(recipe, garment.mark, "garment '" + garment.name + "' has no cloth left on this template",
             "look at its openings: hem, top, neck, cuts");
    }
    RawMeshNode node;
    node.name = "garment." + garment.name;
    node.primitives = sewCloth(frame, garment, cloth);
    const auto first = static_cast<std::uint32_t>(outfit.asset.materials.size());
    std::vector<RawMaterial> materials = makeMaterials(garment, outfit.asset.images);
    const auto same = sameCloth(outfit.asset.materials, mains, materials[0]);
    if (same) materials.erase(materials.begin());
    for (RawPrimitive& primitive : node.primitives) {
      const std::uint32_t label = primitive.material;
      primitive.material = same ? (label == 0 ? *same : first + label - 1) : first + label;
    }
    if (!same) mains.push_back(first);
    outfit.asset.materials.insert(outfit.asset.materials.end(), materials.begin(), materials.end());
    outfit.garments.push_back(figuresOf(garment, cloth.mesh, node, body.surface()));
    warnAbout(recipe, outfit);
    below.push_back(std::move(cloth));
    outfit.asset.meshes.push_back(std::move(node));
  }
  return outfit;
}

}  // namespace ensemble
