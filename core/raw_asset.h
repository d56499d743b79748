// A glTF file's content in plain, mutable form: what gltf_file.h reads and writes.
//
// Everything geometric is brought into one frame, *model space*: metres, the pose in which the
// mesh is bound, standing as the file's scene shows it at rest. Vertices of skinned and rigid
// (parented to a joint) meshes alike are in model space, and `Joint::joint_from_model` agrees.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/math.h"

namespace ensemble {

/// Up to four joints that move a vertex, weights descending and summing to 1 (0 if unskinned).
struct SkinBinding {
  std::array<std::uint16_t, 4> joints{};  ///< indices into RawSkeleton::joints; 0 where weight is 0
  std::array<float, 4> weights{};
  bool operator==(const SkinBinding&) const = default;
};

/// One corner's attributes (a wedge, design 2).
struct RawVertex {
  Vec3 position{0.0f};  ///< model space, metres
  Vec3 normal{0.0f, 1.0f, 0.0f};
  Vec2 uv{0.0f};  ///< base colour's texture coordinates, KHR_texture_transform applied; v down
  SkinBinding skin;
  bool operator==(const RawVertex&) const = default;
};

using Triangle = std::array<std::uint32_t, 3>;  ///< corner indices, counter-clockwise seen from outside

/// Where a vertex goes as its mesh gets coarser (collapse.h).
struct VertexCollapse {
  std::uint32_t target = 0;  ///< the vertex that it moves onto; itself: its faces have all gone, or it stays
  std::uint8_t level = 0;    ///< the first level of detail without it, from 1 (0 shows all); 0: it never goes
  bool operator==(const VertexCollapse&) const = default;
};

/// Triangles of one material.
struct RawPrimitive {
  std::uint32_t material = 0;  ///< index into RawAsset::materials, always valid
  std::vector<RawVertex> vertices;
  std::vector<Triangle> faces;  ///< in the file's order, indices into vertices
  /// `_TEMPLATE_VERTEX` of each vertex, #V, or empty where the file has none (design 1).
  std::vector<std::uint32_t> template_vertices;
  /// `_HIDE` of each vertex, #V, or empty: where all corners of a body face have more than 0.5, it is hidden,
  /// where all have less than -0.5, it is kept. Read, never written.
  std::vector<float> hide;
  /// `_COLLAPSE` of each vertex, #V, or empty where the mesh has no levels.
  std::vector<VertexCollapse> collapses;
  bool operator==(const RawPrimitive&) const = default;
};

/// A node with a mesh.
struct RawMeshNode {
  std::string name;          ///< the node's name, else its mesh's, else "node N"
  std::string json_pointer;  ///< where it stands, e.g. "/nodes/3"; empty when made by us
  bool skinned = true;       ///< false: neither a skin nor a joint among its ancestors
  std::vector<RawPrimitive> primitives;
};

enum class AlphaMode : std::uint8_t { kOpaque, kMask };

struct RawMaterial {
  std::string name;
  Vec4 base_color{1.0f};                  ///< linear RGBA factor
  std::optional<std::uint32_t> image;     ///< base colour texture, index into RawAsset::images
  bool repeat_u = true, repeat_v = true;  ///< false: clamp to edge (mirrored repeat counts as repeat)
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool has_name = true;  ///< false: the file names none, and `name` is a stand-in
  bool operator==(const RawMaterial&) const = default;
};

/// An image as its file holds it, PNG or JPEG; image_file.h decodes it.
struct RawImage {
  std::string name;
  std::string mime_type;         ///< "image/png" or "image/jpeg"
  std::vector<std::byte> bytes;  ///< the encoded file; its header has been checked
  std::uint32_t width = 0, height = 0;
  bool operator==(const RawImage&) const = default;
};

/// A node that moves vertices or stands above one that does. Parents come before children.
struct RawBone {
  std::string name;
  std::int32_t parent = -1;  ///< index into RawSkeleton::bones, -1 for a root
  Transform rest;            ///< in the parent's frame
};

/// An entry of the skin: the bones that vertices may name.
struct RawJoint {
  std::uint32_t bone = 0;       ///< index into RawSkeleton::bones
  Mat4 joint_from_model{1.0f};  ///< inverse bind matrix for model space
};

struct RawSkeleton {
  std::vector<RawBone> bones;
  std::vector<RawJoint> joints;  ///< in the skin's order
};

enum class Interpolation : std::uint8_t { kLinear, kStep, kCubicSpline };
enum class ChannelPath : std::uint8_t { kTranslation, kRotation, kScale };

/// One animated property of one bone.
struct RawChannel {
  std::uint32_t bone = 0;
  ChannelPath path = ChannelPath::kRotation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times;  ///< seconds, strictly ascending, finite
  /// #times values (xyz or quaternion xyzw), or 3 x #times (in-tangent, value, out-tangent) for
  /// kCubicSpline.
  std::vector<Vec4> values;
};

struct RawClip {
  std::string name;
  std::vector<RawChannel> channels;
};

struct RawAsset {
  std::vector<RawMeshNode> meshes;  ///< nodes with a mesh, in the order of the file's nodes
  std::vector<RawMaterial> materials;
  std::vector<RawImage> images;
  RawSkeleton skeleton;  ///< without joints where the file has no skin
  std::vector<RawClip> clips;
  std::string copyright;          ///< asset.copyright, kept when written
  std::string extras_json;        ///< the document's own `extras` as JSON text, or empty
  std::string scene_extras_json;  ///< the default scene's `extras` as JSON text, or empty
  /// What was read but can't be used, each once ("normal maps", "morph targets of node 'Hat'").
  std::vector<std::string> dropped;
  /// Other things the user should know, whole sentences ("node 'Hat': 5 influences ...").
  std::vector<std::string> warnings;
};

}  // namespace ensemble
