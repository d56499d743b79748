#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/check.h"
#include "core/gltf_draco.h"
#include "core/gltf_file.h"
#include "core/gltf_glb_builder.h"
#include "core/gltf_weld.h"

namespace ensemble {
namespace {

using Json = GlbBuilder::Json;

constexpr int kUint8 = 5121, kUint16 = 5123, kUint32 = 5125, kFloat = 5126;

Json toJson(const Vec3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
Json toJson(const Quat& q) {
  return {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z),
          static_cast<double>(q.w)};
}

/// Writes one asset. Each method adds one part of the document.
class GlbWriter {
 public:
  GlbWriter(const RawAsset& asset, const GlbWriteOptions& options) : asset_(asset), options_(options) {}

  std::vector<std::byte> write() {
    addHeader();
    addMaterials();
    addBones();
    addMeshNodes();
    addSkin();
    addScene();
    addClips();
    return builder_.finish();
  }

 private:
  void addHeader() {
    Json asset{{"version", "2.0"}, {"generator", "Ensemble"}};
    if (!asset_.copyright.empty()) asset["copyright"] = asset_.copyright;
    builder_.json["asset"] = std::move(asset);
    const bool any_mesh = std::any_of(asset_.meshes.begin(), asset_.meshes.end(), isWritten);
    if (options_.draco && any_mesh) {
      builder_.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
      builder_.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    }
    if (!asset_.extras_json.empty()) builder_.json["extras"] = Json::parse(asset_.extras_json);
  }

  static bool isWritten(const RawMeshNode& mesh) {
    return std::any_of(mesh.primitives.begin(), mesh.primitives.end(),
                       [](const RawPrimitive& primitive) { return !primitive.faces.empty(); });
  }

  // Materials and images in use, renumbered in their old order.
  void addMaterials() {
    std::vector<bool> used(asset_.materials.size(), false);
    for (const RawMeshNode& mesh : asset_.meshes) {
      for (const RawPrimitive& primitive : mesh.primitives) {
        ENSEMBLE_CHECK(primitive.material < used.size());
        if (!primitive.faces.empty()) used[primitive.material] = true;
      }
    }
    addImages(used);
    Json materials = Json::array();
    material_numbers_.assign(used.size(), 0);
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      material_numbers_[i] = materials.size();
      materials.push_back(materialJson(asset_.materials[i]));
    }
    if (!materials.empty()) builder_.json["materials"] = std::move(materials);
    if (!textures_.empty()) builder_.json["textures"] = std::move(textures_);
    if (!samplers_.empty()) builder_.json["samplers"] = std::move(samplers_);
  }

  void addImages(const std::vector<bool>& material_used) {
    std::map<std::uint32_t, std::size_t> numbers;
    for (std::size_t i = 0; i < material_used.size(); ++i) {
      const auto& image = asset_.materials[i].image;
      if (material_used[i] && image) numbers[*image] = 0;
    }
    Json images = Json::array();
    for (auto& [source, number] : numbers) {
      ENSEMBLE_CHECK(source < asset_.images.size());
      const RawImage& image = asset_.images[source];
      number = images.size();
      Json entry{{"bufferView", builder_.addView(image.bytes)}, {"mimeType", image.mime_type}};
      if (!image.name.empty()) entry["name"] = image.name;
      images.push_back(std::move(entry));
    }
    image_numbers_ = std::move(numbers);
    if (!images.empty()) builder_.json["images"] = std::move(images);
  }

  Json materialJson(const RawMaterial& material) {
    Json json = Json::object();
    if (!material.name.empty()) json["name"] = material.name;
    Json pbr{{"metallicFactor", 0.0}};
    if (material.base_color != Vec4(1.0f)) {
      pbr["baseColorFactor"] = Json::array();
      for (int i = 0; i < 4; ++i)
        pbr["baseColorFactor"].push_back(static_cast<double>(material.base_color[i]));
    }
    if (material.image) pbr["baseColorTexture"] = {{"index", addTexture(material)}};
    json["pbrMetallicRoughness"] = std::move(pbr);
    if (material.alpha_mode == AlphaMode::kMask) {
      json["alphaMode"] = "MASK";
      json["alphaCutoff"] = static_cast<double>(material.alpha_cutoff);
    }
    if (material.double_sided) json["doubleSided"] = true;
    return json;
  }

  std::size_t addTexture(const RawMaterial& material) {
    Json sampler{{"wrapS", material.repeat_u ? 10497 : 33071}, {"wrapT", material.repeat_v ? 10497 : 33071}};
    Json texture{{"sampler", findOrAdd(samplers_, sampler)}, {"source", image_numbers_.at(*material.image)}};
    return findOrAdd(textures_, texture);
  }

  static std::size_t findOrAdd(Json& array, const Json& entry) {
    for (std::size_t i = 0; i < array.size(); ++i) {
      if (array[i] == entry) return i;
    }
    array.push_back(entry);
    return array.size() - 1;
  }

  void addBones() {
    const std::vector<RawBone>& bones = asset_.skeleton.bones;
    for (std::size_t i = 0; i < bones.size(); ++i) {
      const RawBone& bone = bones[i];
      Json node = Json::object();
      if (!bone.name.empty()) node["name"] = bone.name;
      if (bone.rest.translation != Vec3(0.0f)) node["translation"] = toJson(bone.rest.translation);
      if (bone.rest.rotation != Quat(1, 0, 0, 0)) node["rotation"] = toJson(bone.rest.rotation);
      if (bone.rest.scale != Vec3(1.0f)) node["scale"] = toJson(bone.rest.scale);
      nodes_.push_back(std::move(node));
      ENSEMBLE_CHECK(bone.parent < static_cast<std::int32_t>(i));
      if (bone.parent < 0) {
        roots_.push_back(i);
      } else {
        nodes_[static_cast<std::size_t>(bone.parent)]["children"].push_back(i);
      }
    }
  }

  void addMeshNodes() {
    Json meshes = Json::array();
    for (const RawMeshNode& mesh : asset_.meshes) {
      if (!isWritten(mesh)) continue;
      Json primitives = Json::array();
      for (const RawPrimitive& primitive : mesh.primitives) {
        if (!primitive.faces.empty()) primitives.push_back(primitiveJson(primitive, mesh.skinned));
      }
      Json node = Json::object();
      if (!mesh.name.empty()) node["name"] = mesh.name;
      node["mesh"] = meshes.size();
      if (mesh.skinned) node["skin"] = 0;
      Json entry = Json::object();
      if (!mesh.name.empty()) entry["name"] = mesh.name;
      entry["primitives"] = std::move(primitives);
      meshes.push_back(std::move(entry));
      roots_.push_back(nodes_.size());
      nodes_.push_back(std::move(node));
    }
    if (!meshes.empty()) builder_.json["meshes"] = std::move(meshes);
  }

  PrimitiveLayout layoutOf(const RawPrimitive& primitive, bool skinned) const {
    PrimitiveLayout layout;
    layout.uv = asset_.materials[primitive.material].image.has_value() ||
                std::any_of(primitive.vertices.begin(), primitive.vertices.end(),
                            [](const RawVertex& vertex) { return vertex.uv != Vec2(0.0f); });
    layout.skin = skinned;
    layout.wide_joints = asset_.skeleton.joints.size() > 256;
    layout.template_vertices = !primitive.template_vertices.empty();
    layout.collapses = !primitive.collapses.empty();
    layout.wide_collapses = primitive.vertices.size() > 65536;
    return layout;
  }

  // Bindings as settleBinding leaves them, so that the validator accepts the weights.
  static RawPrimitive settled(RawPrimitive primitive) {
    for (RawVertex& vertex : primitive.vertices) {
      std::array<std::pair<std::uint32_t, float>, 4> influences;
      for (std::size_t i = 0; i < 4; ++i) influences[i] = {vertex.skin.joints[i], vertex.skin.weights[i]};
      vertex.skin = settleBinding(influences);
    }
    return primitive;
  }

  Json primitiveJson(const RawPrimitive& given, bool skinned) {
    checkPrimitive(given, skinned);
    const RawPrimitive primitive = skinned ? settled(given) : given;
    const PrimitiveLayout layout = layoutOf(primitive, skinned);
    Json json{{"attributes", Json::object()}};
    if (options_.draco) {
      addDraco(primitive, layout, json);
    } else {
      addAttributes(primitive, layout, json["attributes"]);
      json["indices"] = addIndices(primitive);
    }
    json["material"] = material_numbers_[primitive.material];
    return json;
  }

  void checkPrimitive(const RawPrimitive& primitive, bool skinned) const {
    for (const Triangle& face : primitive.faces) {
      for (const std::uint32_t corner : face) ENSEMBLE_CHECK(corner < primitive.vertices.size());
    }
    ENSEMBLE_CHECK(primitive.template_vertices.empty() ||
                   primitive.template_vertices.size() == primitive.vertices.size());
    ENSEMBLE_CHECK(primitive.collapses.empty() || primitive.collapses.size() == primitive.vertices.size());
    if (!skinned) return;
    for (const RawVertex& vertex : primitive.vertices) {
      for (const std::uint16_t joint : vertex.skin.joints)
        ENSEMBLE_CHECK(joint < asset_.skeleton.joints.size());
    }
  }

  template <class T, class Get>
  std::size_t addAttribute(ViewKind kind, const RawPrimitive& primitive, AccessorShape shape,
                           const Get& get) {
    std::vector<T> values;
    for (const RawVertex& vertex : primitive.vertices) get(vertex, values);
    return builder_.addAccessor<T>(kind, values, primitive.vertices.size(), shape);
  }

  void addAttributes(const RawPrimitive& primitive, const PrimitiveLayout& layout, Json& attributes) {
    Vec3 min = primitive.vertices[0].position, max = min;
    const std::size_t position =
        addAttribute<float>(ViewKind::kPosition, primitive, {"VEC3"}, [&](const RawVertex& v, auto& out) {
          min = glm::min(min, v.position);
          max = glm::max(max, v.position);
          out.insert(out.end(), {v.position.x, v.position.y, v.position.z});
        });
    builder_.setBounds(position, std::span(&min[0], 3), std::span(&max[0], 3));
    attributes["POSITION"] = position;
    attributes["NORMAL"] =
        addAttribute<float>(ViewKind::kNormal, primitive, {"VEC3"}, [](const RawVertex& v, auto& out) {
          out.insert(out.end(), {v.normal.x, v.normal.y, v.normal.z});
        });
    if (layout.uv) {
      attributes["TEXCOORD_0"] =
          addAttribute<float>(ViewKind::kUv, primitive, {"VEC2"}, [](const RawVertex& v, auto& out) {
            out.insert(out.end(), {v.uv.x, v.uv.y});
          });
    }
    if (layout.skin) addBindings(primitive, layout, attributes);
    if (layout.template_vertices) {
      const std::vector<float> numbers(primitive.template_vertices.begin(),
                                       primitive.template_vertices.end());
      attributes["_TEMPLATE_VERTEX"] =
          builder_.addAccessor<float>(ViewKind::kTemplateVertex, numbers, numbers.size(), {"SCALAR"});
    }
    if (layout.collapses) {
      attributes["_COLLAPSE"] = layout.wide_collapses ? addCollapses<float>(primitive, kFloat)
                                                      : addCollapses<std::uint16_t>(primitive, kUint16);
    }
  }

  template <class T>
  std::size_t addCollapses(const RawPrimitive& primitive, int component_type) {
    const std::vector<T> values = collapseValues<T>(primitive);
    return builder_.addAccessor<T>(sizeof(T) == 2 ? ViewKind::kCollapse : ViewKind::kWideCollapse, values,
                                   primitive.vertices.size(), {"VEC2", component_type});
  }

  void addBindings(const RawPrimitive& primitive, const PrimitiveLayout& layout, Json& attributes) {
    const auto copy = [](const RawVertex& v, auto& out) {
      for (const std::uint16_t joint : v.skin.joints) {
        out.push_back(static_cast<typename std::remove_reference_t<decltype(out)>::value_type>(joint));
      }
    };
    attributes["JOINTS_0"] =
        layout.wide_joints
            ? addAttribute<std::uint16_t>(ViewKind::kJoints, primitive, {"VEC4", kUint16}, copy)
            : addAttribute<std::uint8_t>(ViewKind::kJoints, primitive, {"VEC4", kUint8}, copy);
    attributes["WEIGHTS_0"] =
        addAttribute<float>(ViewKind::kWeights, primitive, {"VEC4"}, [](const RawVertex& v, auto& out) {
          out.insert(out.end(), v.skin.weights.begin(), v.skin.weights.end());
        });
  }

  // 16-bit indices where they fit; 65535 itself is reserved for primitive restart.
  static int indexType(const RawPrimitive& primitive) {
    return primitive.vertices.size() <= 65535 ? kUint16 : kUint32;
  }

  std::size_t addIndices(const RawPrimitive& primitive) {
    const std::size_t count = primitive.faces.size() * 3;
    if (indexType(primitive) == kUint32) {
      return builder_.addAccessor<Triangle>(ViewKind::kIndices, primitive.faces, count, {"SCALAR", kUint32});
    }
    std::vector<std::uint16_t> narrow;
    narrow.reserve(count);
    for (const Triangle& face : primitive.faces) {
      for (const std::uint32_t corner : face) narrow.push_back(static_cast<std::uint16_t>(corner));
    }
    return builder_.addAccessor<std::uint16_t>(ViewKind::kIndices, narrow, count, {"SCALAR", kUint16});
  }

  void addDraco(const RawPrimitive& primitive, const PrimitiveLayout& layout, Json& json) {
    const DracoData data = encodeDraco(primitive, layout, options_);
    Json ids = Json::object();
    for (const auto& [name, id] : data.attribute_ids) {
      AccessorShape shape{"VEC4", kFloat};
      if (name == "POSITION" || name == "NORMAL") shape.type = "VEC3";
      if (name == "TEXCOORD_0") shape.type = "VEC2";
      if (name == "_TEMPLATE_VERTEX") shape.type = "SCALAR";
      if (name == "_COLLAPSE") shape = {"VEC2", layout.wide_collapses ? kFloat : kUint16};
      if (name == "JOINTS_0") shape.component_type = layout.wide_joints ? kUint16 : kUint8;
      const std::size_t accessor = builder_.addEmptyAccessor(primitive.vertices.size(), shape);
      if (name == "POSITION") {
        builder_.setBounds(accessor, std::span(&data.position_min[0], 3),
                           std::span(&data.position_max[0], 3));
      }
      json["attributes"][name] = accessor;
      ids[name] = id;
    }
    json["indices"] = builder_.addEmptyAccessor(primitive.faces.size() * 3, {"SCALAR", indexType(primitive)});
    json["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", builder_.addView(data.bytes)},
                                                        {"attributes", std::move(ids)}};
  }

  void addSkin() {
    const RawSkeleton& skeleton = asset_.skeleton;
    if (skeleton.joints.empty()) {
      for (const RawMeshNode& mesh : asset_.meshes) ENSEMBLE_CHECK(!mesh.skinned || !isWritten(mesh));
      return;
    }
    std::vector<float> matrices;
    Json joints = Json::array();
    for (const RawJoint& joint : skeleton.joints) {
      ENSEMBLE_CHECK(joint.bone < skeleton.bones.size());
      joints.push_back(joint.bone);
      for (int i = 0; i < 16; ++i) matrices.push_back(joint.joint_from_model[i / 4][i % 4]);
    }
    const std::size_t accessor =
        builder_.addAccessor<float>(ViewKind::kInverseBind, matrices, skeleton.joints.size(), {"MAT4"});
    builder_.json["skins"] =
        Json::array({{{"inverseBindMatrices", accessor}, {"joints", std::move(joints)}}});
  }

  // A skin's joints must have a common root; where they have several, a plain node is put above them.
  void addScene() {
    const std::size_t bone_count = asset_.skeleton.bones.size();
    const auto is_bone = [bone_count](std::size_t root) { return root < bone_count; };
    if (!asset_.skeleton.joints.empty() && std::count_if(roots_.begin(), roots_.end(), is_bone) > 1) {
      Json armature{{"name", "skeletons"}, {"children", Json::array()}};
      for (const std::size_t root : roots_) {
        if (is_bone(root)) armature["children"].push_back(root);
      }
      std::erase_if(roots_, is_bone);
      roots_.push_back(nodes_.size());
      nodes_.push_back(std::move(armature));
    }
    Json scene = Json::object();
    if (!roots_.empty()) scene["nodes"] = roots_;
    if (!asset_.scene_extras_json.empty()) scene["extras"] = Json::parse(asset_.scene_extras_json);
    builder_.json["scene"] = 0;
    builder_.json["scenes"] = Json::array({std::move(scene)});
    if (!nodes_.empty()) builder_.json["nodes"] = std::move(nodes_);
  }

  std::size_t addTimes(const std::vector<float>& times) {
    const auto [entry, is_new] = accessor_of_times_.try_emplace(times, 0);
    if (is_new) {
      entry->second = builder_.addAccessor<float>(ViewKind::kAnimation, times, times.size(), {"SCALAR"});
      builder_.setBounds(entry->second, std::span(&times.front(), 1), std::span(&times.back(), 1));
    }
    return entry->second;
  }

  void addClips() {
    Json animations = Json::array();
    for (const RawClip& clip : asset_.clips) {
      if (clip.channels.empty()) continue;
      Json channels = Json::array(), samplers = Json::array();
      for (const RawChannel& channel : clip.channels) addChannel(channel, channels, samplers);
      Json animation = Json::object();
      if (!clip.name.empty()) animation["name"] = clip.name;
      animation["channels"] = std::move(channels);
      animation["samplers"] = std::move(samplers);
      animations.push_back(std::move(animation));
    }
    if (!animations.empty()) builder_.json["animations"] = std::move(animations);
  }

  void addChannel(const RawChannel& channel, Json& channels, Json& samplers) {
    constexpr const char* kInterpolations[] = {"LINEAR", "STEP", "CUBICSPLINE"};
    constexpr const char* kPaths[] = {"translation", "rotation", "scale"};
    ENSEMBLE_CHECK(!channel.times.empty());
    ENSEMBLE_CHECK(channel.bone < asset_.skeleton.bones.size());
    const bool is_rotation = channel.path == ChannelPath::kRotation;
    std::vector<float> values;
    for (const Vec4& value : channel.values) {
      for (int c = 0; c < (is_rotation ? 4 : 3); ++c) values.push_back(value[c]);
    }
    const std::size_t input = addTimes(channel.times);
    const std::size_t output = builder_.addAccessor<float>(
        ViewKind::kAnimation, values, channel.values.size(), {is_rotation ? "VEC4" : "VEC3"});
    channels.push_back(
        {{"sampler", samplers.size()},
         {"target", {{"node", channel.bone}, {"path", kPaths[static_cast<std::size_t>(channel.path)]}}}});
    Json sampler{{"input", input}, {"output", output}};
    if (channel.interpolation != Interpolation::kLinear) {
      sampler["interpolation"] = kInterpolations[static_cast<std::size_t>(channel.interpolation)];
    }
    samplers.push_back(std::move(sampler));
  }

  const RawAsset& asset_;
  const GlbWriteOptions& options_;
  GlbBuilder builder_;
  Json nodes_ = Json::array(), textures_ = Json::array(), samplers_ = Json::array();
  std::vector<std::size_t> roots_, material_numbers_;
  std::map<std::uint32_t, std::size_t> image_numbers_;
  std::map<std::vector<float>, std::size_t> accessor_of_times_;
};

}  // namespace

std::vector<std::byte> writeGlb(const RawAsset& asset, const GlbWriteOptions& options) {
  return GlbWriter(asset, options).write();
}

}  // namespace ensemble
