// Lister section 3.1.3-3.1.4 ("tagged", content preparation), with faces matched instead of counted
// (design 3).
#include "assetpipe/tag_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <span>

#include "assetpipe/body_motion.h"
#include "assetpipe/explain.h"
#include "assetpipe/match_faces.h"
#include "assetpipe/mesh_levels.h"
#include "assetpipe/outfit_properties.h"
#include "assetpipe/painted_faces.h"
#include "assetpipe/segment.h"
#include "assetpipe/tag_warnings.h"
#include "assetpipe/unmatched_parts.h"
#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr float kJointTolerance = 0.001f;  // metres

/// A primitive of the outfit that is body.
struct BodyPrimitive {
  const RawPrimitive* primitive = nullptr;
  std::uint32_t material = EmbeddedFace::kAnyMaterial;  ///< index into TemplateBody::materials
};

/// Which material of the template a name means: the same name, else the same without `.001`.
std::uint32_t templateMaterial(const TemplateBody& body, const std::string& name) {
  for (const auto strip : {false, true}) {
    for (const BodyPart& part : body.parts) {
      const std::string& known = body.materials[part.material].name;
      const bool same = strip ? withoutBlenderSuffix(known) == withoutBlenderSuffix(name) : known == name;
      if (same && !known.empty()) return part.material;
    }
  }
  return EmbeddedFace::kAnyMaterial;
}

std::string listNames(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

class OutfitTagger {
 public:
  OutfitTagger(const RawAsset& outfit, const TemplateBody& body, const TagOptions& options,
               const std::string& file, std::vector<std::string>& warnings)
      : outfit_(outfit),
        body_(body),
        options_(options),
        file_(file),
        warnings_(warnings),
        own_(readOutfitProperties(outfit, body, options.occlusion, file)) {}

  Item tag(const std::string& name) {
    item_.name = name;
    item_.materials = outfit_.materials;
    item_.images = outfit_.images;
    item_.slot = own_.slot;
    item_.layer = own_.layer;
    splitBodyFromGarments();
    matchBody();  // before the joints: of another person's outfit its body tells most
    mapJoints();
    for (Garment& garment : item_.garments) {
      for (RawPrimitive& part : garment.parts) part = withTemplateJoints(std::move(part));
    }
    findGarmentLevels();
    if (matches_.unmatched > 0) keepUnmatchedFaces();
    if (own_.occlusion != Occlusion::kAuthored) findHiddenFaces();
    applyOverrides();
    explain();
    item_.tags = tagRegions(body_, item_.visible, item_.extra_body);
    warnAbout(item_, body_, own_.occlusion, holes_ ? &*holes_ : nullptr, options_.hidden, warnings_);
    return std::move(item_);
  }

 private:
  [[noreturn]] void fail(const std::string& where, const std::string& what, const std::string& mend) const {
    throw InputError({file_, where, what, mend});
  }

  /// After this the garments stay as they are: rays find what the reduced ones hide.
  void findGarmentLevels() {
    const std::vector<std::vector<Mat4>> poses = matricesInClips(body_);
    for (Garment& garment : item_.garments) {
      const std::uint32_t most = options_.garment_faces;
      const std::uint32_t left = most == 0 ? 0 : reduceFaces(garment, most, poses);
      if (left > most) {
        warnings_.push_back(
            fmt::format("garment '{}' keeps {} faces, more than {}: its seams and borders leave "
                        "no fewer",
                        garment.name, left, most));
      }
      findLevels(garment, poses);
    }
  }

  /// Finds each joint that carries weight in the template's skeleton, by name and bind position.
  void mapJoints() {
    const RawSkeleton& ours = body_.skeleton;
    const RawSkeleton& theirs = outfit_.skeleton;
    std::map<std::string, std::uint32_t> joint_by_name;
    for (std::uint32_t j = 0; j < ours.joints.size(); ++j)
      joint_by_name.try_emplace(ours.bones[ours.joints[j].bone].name, j);

    const std::vector<bool> used = usedJoints();
    joint_map_.assign(theirs.joints.size(), 0);
    std::vector<std::string> missing;
    const float tolerance = std::max(kJointTolerance, 5.0f * options_.tolerance);
    for (std::uint32_t j = 0; j < theirs.joints.size(); ++j) {
      if (!used[j]) continue;
      const std::string& name = theirs.bones[theirs.joints[j].bone].name;
      const auto found = joint_by_name.find(name);
      if (found == joint_by_name.end()) {
        missing.push_back(name);
        continue;
      }
      joint_map_[j] = static_cast<std::uint16_t>(found->second);
      const Vec3 here = bindPosition(theirs.joints[j]), there = bindPosition(ours.joints[found->second]);
      const float distance = glm::distance(here, there);
      if (!(distance <= tolerance)) {
        fail("/skins",
             fmt::format("joint '{}' stands {:.1f} mm from the template's in the bind pose", name,
                         distance * 1000.0f),
             "bind the outfit to the template's own skeleton, in the template's pose");
      }
    }
    if (!missing.empty()) {
      fail("/skins",
           "the outfit is bound to joints that the template's skeleton lacks: " + listNames(missing),
           "bind it to the template's skeleton, or move these weights to the template's joints");
    }
  }

  std::vector<bool> usedJoints() const {
    std::vector<bool> used(outfit_.skeleton.joints.size(), false);
    for (const RawMeshNode& node : outfit_.meshes) {
      if (!node.skinned) continue;
      for (const RawPrimitive& primitive : node.primitives) {
        for (const RawVertex& vertex : primitive.vertices) {
          for (std::size_t i = 0; i < 4; ++i) {
            if (vertex.skin.weights[i] > 0.0f) used[vertex.skin.joints[i]] = true;
          }
        }
      }
    }
    return used;
  }

  static Vec3 bindPosition(const RawJoint& joint) { return Vec3(glm::inverse(joint.joint_from_model)[3]); }

  void splitBodyFromGarments() {
    bool found_node = options_.body_node.empty();
    for (const RawMeshNode& node : outfit_.meshes) {
      const bool is_body_node = !options_.body_node.empty() && node.name == options_.body_node;
      found_node = found_node || is_body_node;
      Garment garment{node.name, {}};
      for (const RawPrimitive& primitive : node.primitives) {
        const std::uint32_t material = templateMaterial(body_, outfit_.materials[primitive.material].name);
        const bool is_body =
            options_.body_node.empty() ? material != EmbeddedFace::kAnyMaterial : is_body_node;
        if (is_body) {
          body_primitives_.push_back({&primitive, material});
        } else {
          garment.parts.push_back(primitive);
        }
      }
      if (garment.parts.empty()) continue;
      if (garment.parts.size() < node.primitives.size()) judgeMixedNode(node, garment);
      if (!node.skinned) {
        fail(node.json_pointer, "garment '" + node.name + "' is not skinned",
             "bind it to the skeleton, parent it to a joint, or leave it out of the export");
      }
      addGarment(std::move(garment));
    }
    if (!found_node) {
      fail("/nodes", "no mesh node is named '" + options_.body_node + "'",
           "name one with --body (`ensemble inspect` lists them)");
    }
    if (body_primitives_.empty()) failWithoutBody();
  }

  /// A node with both body and other materials: where the others' faces are the template's, their
  /// name is wrong; else they may be clothes, or a part of the body that the template lacks.
  void judgeMixedNode(const RawMeshNode& node, const Garment& garment) {
    for (const RawPrimitive& part : garment.parts) {
      std::vector<EmbeddedFace> faces;
      appendFaces(part, EmbeddedFace::kAnyMaterial, faces);
      const std::string what = fmt::format("the {} faces of material '{}' in node '{}'", faces.size(),
                                           outfit_.materials[part.material].name, node.name);
      if (2 * matchFaces(body_, faces, options_.tolerance).unmatched < faces.size()) {
        fail(node.json_pointer, what + " are the template's body, which has no region of this name",
             "name the material as the template's (" + listNames(regionMaterials()) +
                 "), or export it as a node of its own if it is a garment");
      }
      warnings_.push_back(what + " are in no region of the template (" + listNames(regionMaterials()) +
                          "), so they count as a garment");
    }
  }

  std::vector<std::string> regionMaterials() const {
    std::vector<std::string> names;
    for (const BodyPart& part : body_.parts) names.push_back(body_.materials[part.material].name);
    return names;
  }

  static void appendFaces(const RawPrimitive& primitive, std::uint32_t material,
                          std::vector<EmbeddedFace>& faces) {
    for (const Triangle& face : primitive.faces) {
      EmbeddedFace& added = faces.emplace_back();
      added.material = material;
      for (std::size_t k = 0; k < 3; ++k) added.corners[k] = primitive.vertices[face[k]].position;
    }
  }

  [[noreturn]] void failWithoutBody() const {
    fail("/materials",
         "there is no body in this outfit: no material is named as one of the template's (" +
             listNames(regionMaterials()) + ")",
         "export the outfit with the body that it dresses, its materials named as the template's, or use "
         "--body NODE");
  }

  /// One garment per node; a second node of the same name gets a number.
  void addGarment(Garment garment) {
    const std::string name = garment.name;
    const auto taken = [&](const std::string& candidate) {
      return std::any_of(item_.garments.begin(), item_.garments.end(),
                         [&](const Garment& other) { return other.name == candidate; });
    };
    for (int copy = 2; taken(garment.name); ++copy) garment.name = name + "_" + std::to_string(copy);
    item_.garments.push_back(std::move(garment));
  }

  RawPrimitive withTemplateJoints(RawPrimitive primitive) const {
    for (RawVertex& vertex : primitive.vertices) {
      for (std::size_t i = 0; i < 4; ++i) {
        std::uint16_t& joint = vertex.skin.joints[i];
        joint = vertex.skin.weights[i] > 0.0f ? joint_map_[joint] : std::uint16_t{0};
      }
    }
    primitive.template_vertices.clear();
    primitive.hide.clear();
    return primitive;
  }

  void matchBody() {
    std::vector<EmbeddedFace> embedded;
    for (const BodyPrimitive& part : body_primitives_) appendFaces(*part.primitive, part.material, embedded);
    matches_ = matchFaces(body_, embedded, options_.tolerance);
    refuseAnotherBody();
    item_.visible.assign(body_.faces.size(), 0);
    for (const FaceId face : matches_.template_face) {
      if (face.valid()) item_.visible[face] = 1;
    }
  }

  void refuseAnotherBody() const {
    const std::size_t face_count = matches_.template_face.size();
    if (matches_.unmatched <= kMaxUnmatchedShare * static_cast<double>(face_count)) return;
    fail("/meshes",
         fmt::format("{} of the {} body faces match no face of the template; corners are {:.2f} mm (median) "
                     "to {:.2f} mm "
                     "(maximum) from it",
                     matches_.unmatched, face_count, matches_.median_distance * 1000.0f,
                     matches_.max_distance * 1000.0f),
         matches_.median_distance > options_.tolerance
             ? "tag it with the template that it was made for"
             : "leave the faces of the template's body as they are, or raise --tolerance");
  }

  /// Design 3: a few faces that a garment reshaped stay as geometry of the outfit.
  void keepUnmatchedFaces() {
    warnings_.push_back(
        fmt::format("{} of the {} body faces match no face of the template (corners up to {:.2f} mm off); "
                    "they stay as geometry of "
                    "the outfit and their regions count as partial",
                    matches_.unmatched, matches_.template_face.size(), matches_.max_distance * 1000.0f));
    std::span<const FaceId> template_face = matches_.template_face;
    for (const BodyPrimitive& part : body_primitives_) {
      const RawPrimitive source = withTemplateJoints(*part.primitive);
      std::vector<ExtraBodyPart> extra =
          unmatchedParts(source, template_face.first(source.faces.size()), body_);
      std::move(extra.begin(), extra.end(), std::back_inserter(item_.extra_body));
      template_face = template_face.subspan(source.faces.size());
    }
  }

  void findHiddenFaces() {
    const Item* worn = &item_;
    authored_.visible = item_.visible;
    holes_ = findHoles(body_, std::span(&worn, 1), options_.hidden);
    BareBody own_bare(body_, options_.hidden);
    const FaceHoles& bare = (options_.bare != nullptr ? *options_.bare : own_bare).holes();
    for (const Region& region : body_.regions) keepUnclothed(region, bare);
    for (std::size_t f = 0; f < body_.faces.size(); ++f) {
      std::uint8_t& visible = item_.visible[FaceId(f)];
      const bool may_show = own_.occlusion == Occlusion::kAuto || visible != 0;
      visible = holes_->faces[FaceId(f)].is_kept && may_show ? 1 : 0;
    }
  }

  /// A region of which the clothes hide nothing stays whole, though the body itself hides some of it (the
  /// inside of a mouth): else every item would have a list of its own for it.
  void keepUnclothed(const Region& region, const FaceHoles& bare) {
    const auto is_clothed = [&](std::uint32_t f) {
      const FaceId face(region.first_face + f);
      return bare.faces[face].is_kept && !holes_->faces[face].is_kept;
    };
    for (std::uint32_t f = 0; f < region.face_count; ++f) {
      if (is_clothed(f)) return;
    }
    for (std::uint32_t f = 0; f < region.face_count; ++f) {
      FaceHole& face = holes_->faces[FaceId(region.first_face + f)];
      face.is_in_bare_region = !face.is_kept;
      face.is_kept = true;
    }
  }

  /// Regions that the item's custom properties keep or hide, then painted faces, whatever else was found.
  void applyOverrides() {
    const auto set = [&](const std::vector<RegionId>& regions, std::uint8_t visible) {
      for (const RegionId id : regions) {
        const Region& region = body_.regions[id];
        for (std::uint32_t f = 0; f < region.face_count; ++f)
          item_.visible[FaceId(region.first_face + f)] = visible;
      }
    };
    set(own_.keep, 1);
    set(own_.hide, 0);
    applyPaint();
  }

  /// Faces of the embedded body that `_HIDE` hides or keeps.
  void applyPaint() {
    authored_.painted.assign(body_.faces.size(), Paint::kNone);
    std::size_t number = 0;
    for (const BodyPrimitive& part : body_primitives_) {
      for (const Triangle& corners : part.primitive->faces) {
        const FaceId face = matches_.template_face[number++];
        const Paint paint = paintOf(*part.primitive, corners);
        if (paint == Paint::kNone || !face.valid()) continue;
        authored_.painted[face] = paint;
        item_.visible[face] = paint == Paint::kKeep ? 1 : 0;
      }
    }
    for (const RawMeshNode& node : outfit_.meshes) {
      if (!isPaintedGarment(node)) continue;
      warnings_.push_back("garment '" + node.name +
                          "' has the attribute _HIDE, which says nothing there; paint the body");
    }
  }

  bool isPaintedGarment(const RawMeshNode& node) const {
    const auto is_body = [&](const RawPrimitive& primitive) {
      return std::any_of(body_primitives_.begin(), body_primitives_.end(),
                         [&](const BodyPrimitive& part) { return part.primitive == &primitive; });
    };
    return std::any_of(node.primitives.begin(), node.primitives.end(), [&](const RawPrimitive& primitive) {
      return !primitive.hide.empty() && !is_body(primitive);
    });
  }

  void explain() const {
    if (options_.explain.empty()) return;
    if (holes_) {
      explainHiddenFaces(options_.explain, body_, item_, authored_, *holes_, options_.hidden);
    } else {
      warnings_.push_back(
          "--explain has nothing to tell: its author chose the hidden faces, none were looked "
          "for; ask for --auto-occlusion");
    }
  }

  const RawAsset& outfit_;
  const TemplateBody& body_;
  const TagOptions& options_;
  const std::string& file_;
  std::vector<std::string>& warnings_;
  std::vector<std::uint16_t> joint_map_;  ///< per joint of the outfit: the template's
  std::vector<BodyPrimitive> body_primitives_;
  FaceMatches matches_;  ///< of the body primitives' faces, in order
  OutfitProperties own_;
  AuthoredFaces authored_;  ///< what the author left visible before rays were asked, and painted
  std::optional<FaceHoles> holes_;
  Item item_;
};

}  // namespace

Item tagOutfit(const RawAsset& outfit, const TemplateBody& body, const TagOptions& options,
               const std::string& name, const std::string& file, std::vector<std::string>& warnings) {
  ENSEMBLE_CHECK(options.tolerance > 0.0f);
  return OutfitTagger(outfit, body, options, file, warnings).tag(name);
}

PerRegion<RegionTag> tagRegions(const TemplateBody& body, const PerFace<std::uint8_t>& visible,
                                const std::vector<ExtraBodyPart>& extra_body) {
  PerRegion<RegionTag> tags(body.regions.size(), RegionTag{Visibility::kHidden, 0});
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    tags[body.region_of_face[FaceId(f)]].visible_faces += visible[FaceId(f)];
  }
  for (std::size_t r = 0; r < tags.size(); ++r) {
    RegionTag& tag = tags[RegionId(r)];
    if (tag.visible_faces == body.regions[RegionId(r)].face_count) {
      tag.visibility = Visibility::kFull;
    } else if (tag.visible_faces > 0) {
      tag.visibility = Visibility::kPartial;
    }
  }
  for (const ExtraBodyPart& extra : extra_body) {
    tags[extra.region].visibility = Visibility::kPartial;
    tags[extra.region].visible_faces += static_cast<std::uint32_t>(extra.part.faces.size());
  }
  return tags;
}

}  // namespace ensemble
