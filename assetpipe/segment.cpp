// Segmentation of the template (Lister section 3.1.3: regions follow material assignments, so that
// the mesh is not fragmented further).
#include "assetpipe/segment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "core/input_error.h"

namespace ensemble {
namespace {

/// A face of the template file, in the file's order.
struct SourceFace {
  const RawPrimitive* primitive = nullptr;
  std::uint32_t face = 0;
  std::uint32_t region = 0;  ///< index into the region names
};

std::vector<std::string> tokensOf(std::string_view name) {
  std::vector<std::string> tokens;
  bool in_token = false, last_lower = false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (!std::isalpha(byte)) {
      in_token = false;
      continue;
    }
    // A capital after a small letter begins a word: LeftForeArm.
    if (!in_token || (std::isupper(byte) && last_lower)) tokens.emplace_back();
    tokens.back() += static_cast<char>(std::tolower(byte));
    in_token = true;
    last_lower = std::islower(byte) != 0;
  }
  return tokens;
}

struct PartWords {
  const char* part;
  std::vector<std::string_view> words;
};

/// In order of precedence: a "hand index" is of the hand, a "fore arm" of the arm.
const std::vector<PartWords>& partWords() {
  static const std::vector<PartWords> words = {
      {"hands",
       {"hand", "finger", "fingers", "thumb", "index", "middle", "mid", "ring", "pinky", "little", "palm",
        "wrist", "metacarpal", "carpal"}},
      {"feet",
       {"foot", "feet", "toe", "toes", "ball", "ankle", "heel", "metatarsals", "metatarsal", "tarsal"}},
      {"head", {"head",    "neck",       "jaw",   "eye",      "eyes",   "eyelid", "eyebrow", "brow",
                "tongue",  "face",       "lip",   "lips",     "cheek",  "nose",   "nostril", "ear",
                "teeth",   "chin",       "mouth", "skull",    "hair",   "lid",    "oris",    "orbicularis",
                "levator", "temporalis", "oculi", "risorius", "special"}},
      {"arms", {"arm", "arms", "upperarm", "lowerarm", "forearm", "elbow", "shldr"}},
      {"legs", {"leg", "legs", "upleg", "upperleg", "lowerleg", "thigh", "shin", "calf", "knee"}},
      {"torso",
       {"spine", "pelvis", "hip", "hips", "chest", "clavicle", "collar", "shoulder", "torso", "abdomen",
        "breast", "pectoral", "waist", "rib", "ribs", "belly", "root", "trunk", "body"}},
  };
  return words;
}

std::string displayName(const RawMeshNode& node) { return "'" + node.name + "'"; }

std::vector<SourceFace> collectFaces(const RawAsset& asset, const SegmentOptions& options,
                                     const std::string& file, std::vector<std::string>& warnings) {
  std::vector<SourceFace> faces;
  bool found_node = options.body_node.empty();
  for (const RawMeshNode& node : asset.meshes) {
    if (!options.body_node.empty() && node.name != options.body_node) continue;
    found_node = true;
    if (!node.skinned) {
      warnings.push_back("node " + displayName(node) + " is not skinned and is left out of the template");
      continue;
    }
    for (const RawPrimitive& primitive : node.primitives) {
      for (std::uint32_t f = 0; f < primitive.faces.size(); ++f) faces.push_back({&primitive, f, 0});
    }
  }
  if (!found_node) {
    throw InputError({file, "/nodes", "no mesh node is named '" + options.body_node + "'",
                      "name one with --body (`ensemble inspect` lists them)"});
  }
  if (asset.skeleton.joints.empty()) {
    throw InputError({file, "/skins", "the template has no skin, so it can't be animated",
                      "bind the body to a skeleton and export it with its skin"});
  }
  if (faces.empty()) {
    throw InputError({file, "/meshes", "the template has no skinned triangles",
                      "bind the body to a skeleton and export it with its skin"});
  }
  return faces;
}

/// Region names by material: a copy's `.001` goes unless two materials would then be one.
std::vector<std::string> materialNames(const RawAsset& asset) {
  std::vector<std::string> names;
  for (const RawMaterial& material : asset.materials) {
    const std::string_view plain = withoutBlenderSuffix(material.name);
    const auto same =
        std::count_if(asset.materials.begin(), asset.materials.end(),
                      [&](const RawMaterial& other) { return withoutBlenderSuffix(other.name) == plain; });
    names.emplace_back(same > 1 ? std::string_view(material.name) : plain);
  }
  return names;
}

/// The joint with the largest weight summed over a face's corners; of equals the first.
std::uint32_t dominantJoint(const RawPrimitive& primitive, const Triangle& face) {
  std::map<std::uint32_t, float> weights;
  for (const std::uint32_t vertex : face) {
    const SkinBinding& skin = primitive.vertices[vertex].skin;
    for (std::size_t i = 0; i < 4; ++i) weights[skin.joints[i]] += skin.weights[i];
  }
  return std::max_element(weights.begin(), weights.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

/// A region name for every joint: its body part, else its nearest known ancestor's; where no joint's
/// name is known, each joint is a region.
std::vector<std::string> regionOfJoints(const RawSkeleton& skeleton) {
  std::vector<std::string> part_of_bone(skeleton.bones.size());
  bool any_known = false;
  for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
    part_of_bone[b] = bodyPartOfJoint(skeleton.bones[b].name);
    any_known = any_known || !part_of_bone[b].empty();
    const std::int32_t parent = skeleton.bones[b].parent;
    if (part_of_bone[b].empty() && parent >= 0)
      part_of_bone[b] = part_of_bone[static_cast<std::size_t>(parent)];
  }
  std::vector<std::string> regions;
  for (const RawJoint& joint : skeleton.joints) {
    const std::string& part = part_of_bone[joint.bone];
    regions.push_back(!any_known ? skeleton.bones[joint.bone].name : part.empty() ? "torso" : part);
  }
  return regions;
}

/// Names regions by first appearance.
class RegionNames {
 public:
  std::uint32_t indexOf(const std::string& name) {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) names_.push_back(name);
    return static_cast<std::uint32_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }
  const std::vector<std::string>& all() const { return names_; }

 private:
  std::vector<std::string> names_;
};

bool ruleTakes(const RegionRule& rule, const std::string& material, const std::string& joint,
               std::uint32_t number) {
  if (std::find(rule.materials.begin(), rule.materials.end(), material) != rule.materials.end()) return true;
  if (std::find(rule.joints.begin(), rule.joints.end(), joint) != rule.joints.end()) return true;
  return std::any_of(rule.faces.begin(), rule.faces.end(),
                     [&](const auto& range) { return range.first <= number && number <= range.second; });
}

RegionNames assignRegions(const RawAsset& asset, const SegmentOptions& options, const std::string& file,
                          std::vector<SourceFace>& faces) {
  const std::vector<std::string> materials = materialNames(asset);
  const std::vector<std::string> joint_regions = regionOfJoints(asset.skeleton);
  RegionNames names;
  for (std::uint32_t number = 0; number < faces.size(); ++number) {
    SourceFace& face = faces[number];
    const Triangle& corners = face.primitive->faces[face.face];
    const std::string& material = materials[face.primitive->material];
    std::string region;
    if (options.by == SegmentBy::kMaterial) {
      region = material;
      if (region.empty() || !asset.materials[face.primitive->material].has_name) {
        throw InputError({file, "/materials", "the template's faces have no material name to make regions of",
                          "give each part of the body a named material, or use --regions joints"});
      }
    } else {
      const std::uint32_t joint = dominantJoint(*face.primitive, corners);
      const std::string& joint_name = asset.skeleton.bones[asset.skeleton.joints[joint].bone].name;
      if (options.by == SegmentBy::kJoints) {
        region = joint_regions[joint];
      } else {
        const auto rule = std::find_if(
            options.rules.begin(), options.rules.end(),
            [&](const RegionRule& candidate) { return ruleTakes(candidate, material, joint_name, number); });
        if (rule == options.rules.end()) {
          throw InputError({file, "/meshes",
                            fmt::format("no region takes face {} (material '{}', joint '{}')", number,
                                        material, joint_name),
                            "name its material or joint in the --regions file"});
        }
        region = rule->name;
      }
    }
    face.region = names.indexOf(region);
  }
  return names;
}

struct VertexBytesLess {
  bool operator()(const RawVertex& a, const RawVertex& b) const {
    // Any order will do that tells bits apart. NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(&a, &b, sizeof(RawVertex)) < 0;
  }
};
static_assert(sizeof(RawVertex) == 3 * 4 + 3 * 4 + 2 * 4 + 4 * 2 + 4 * 4, "RawVertex must have no padding");

/// Appends a part's faces and its own, welded vertices in order of first use.
void appendPart(TemplateBody& body, RegionId region, std::uint32_t material,
                std::span<const SourceFace> faces) {
  std::map<RawVertex, std::uint32_t, VertexBytesLess> numbers;
  body.parts.push_back({region, material, static_cast<std::uint32_t>(body.faces.size()),
                        static_cast<std::uint32_t>(faces.size())});
  for (const SourceFace& source : faces) {
    Triangle corners = source.primitive->faces[source.face];
    for (std::uint32_t& corner : corners) {
      const RawVertex& vertex = source.primitive->vertices[corner];
      const auto [entry, is_new] =
          numbers.try_emplace(vertex, static_cast<std::uint32_t>(body.vertices.size()));
      if (is_new) body.vertices.push(vertex);
      corner = entry->second;
    }
    body.faces.push(corners);
    body.region_of_face.push(region);
  }
  Region& owner = body.regions[region];
  owner.face_count += static_cast<std::uint32_t>(faces.size());
  owner.vertex_count = static_cast<std::uint32_t>(body.vertices.size()) - owner.first_vertex;
}

/// Design 2: all wedges of a position move together.
void shareSkinWeights(TemplateBody& body, std::vector<std::string>& warnings) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  };
  std::map<Vec3, SkinBinding, decltype(less)> binding_at(less);
  std::size_t mended = 0;
  for (RawVertex& vertex : body.vertices) {
    const auto [entry, is_new] = binding_at.try_emplace(vertex.position, vertex.skin);
    if (is_new || entry->second == vertex.skin) continue;
    vertex.skin = entry->second;
    ++mended;
  }
  if (mended > 0) {
    warnings.push_back(
        std::to_string(mended) +
        " vertices at seams had other skin weights than their neighbours at the same position; "
        "they now share them, so that seams can't tear");
  }
}

void addClips(TemplateBody& body, const RawAsset& asset, std::vector<std::string>& warnings) {
  std::set<std::string> names;
  for (const RawClip& raw : asset.clips) {
    Clip clip = sampleClip(asset.skeleton, raw);
    if (clip.name.empty()) clip.name = "clip";
    for (int copy = 2; !names.insert(clip.name).second; ++copy) {
      clip.name = raw.name + "_" + std::to_string(copy);
      if (copy == 2)
        warnings.push_back("two clips are named '" + raw.name + "'; the later one becomes '" + clip.name +
                           "'");
    }
    body.clips.push_back(std::move(clip));
  }
}

}  // namespace

TemplateBody segmentTemplate(const RawAsset& asset, const SegmentOptions& options, const std::string& file,
                             std::vector<std::string>& warnings) {
  std::vector<SourceFace> faces = collectFaces(asset, options, file, warnings);
  const RegionNames regions = assignRegions(asset, options, file, faces);

  TemplateBody body;
  body.materials = asset.materials;
  const std::vector<std::string> material_names = materialNames(asset);
  for (std::size_t m = 0; m < body.materials.size(); ++m) body.materials[m].name = material_names[m];
  body.images = asset.images;
  body.skeleton = asset.skeleton;

  // Sort by region, then material by first appearance, and keep the file's order inside.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> material_rank;  // (region, material)
  for (const SourceFace& face : faces) {
    material_rank.try_emplace({face.region, face.primitive->material},
                              static_cast<std::uint32_t>(material_rank.size()));
  }
  const auto key = [&](const SourceFace& face) {
    return std::pair(face.region, material_rank[{face.region, face.primitive->material}]);
  };
  std::stable_sort(faces.begin(), faces.end(),
                   [&](const SourceFace& a, const SourceFace& b) { return key(a) < key(b); });
  for (std::size_t first = 0; first < faces.size();) {
    std::size_t last = first;
    while (last < faces.size() && key(faces[last]) == key(faces[first])) ++last;
    const std::string& name = regions.all()[faces[first].region];
    if (body.regions.empty() || body.regions.raw().back().name != name) {
      body.regions.push({name, static_cast<std::uint32_t>(body.faces.size()), 0,
                         static_cast<std::uint32_t>(body.vertices.size()), 0});
    }
    appendPart(body, RegionId(body.regions.size() - 1), faces[first].primitive->material,
               std::span(faces).subspan(first, last - first));
    first = last;
  }
  shareSkinWeights(body, warnings);
  addClips(body, asset, warnings);
  return body;
}

std::string_view withoutBlenderSuffix(std::string_view name) {
  if (name.size() > 4 && name[name.size() - 4] == '.' &&
      std::all_of(name.end() - 3, name.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
    name.remove_suffix(4);
  }
  return name;
}

std::string bodyPartOfJoint(std::string_view joint_name) {
  const std::vector<std::string> tokens = tokensOf(joint_name);
  for (const PartWords& part : partWords()) {
    for (const std::string& token : tokens) {
      if (std::find(part.words.begin(), part.words.end(), token) != part.words.end()) return part.part;
    }
  }
  return {};
}

}  // namespace ensemble
