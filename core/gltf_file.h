// The one place that reads and writes glTF.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/raw_asset.h"

namespace ensemble {

/// How a file is read, and limits on what it may claim, so that a hostile one costs bounded time
/// and memory.
struct GltfReadOptions {
  /// Weld each primitive: vertices equal in everything become one, in the place of the first of
  /// them; unused ones go; wedges of one position get one skin binding (design 2). The order of what
  /// stays is the file's, so a welded primitive without unused vertices is not changed at all.
  /// False: vertices keep the file's numbers whatever they hold. For files of our own whose numbers
  /// matter: quantisation (Draco) may have made two of their vertices equal.
  bool weld = true;
  std::uint64_t max_file_bytes = 1ull << 30;
  std::uint32_t max_json_depth = 64;
  std::uint64_t max_json_bytes = 64ull << 20;
  std::uint64_t max_json_values = 1ull << 22;
  std::uint64_t max_vertices = 1ull << 24;  ///< over all primitives; _TEMPLATE_VERTEX is a FLOAT
  std::uint64_t max_faces = 1ull << 25;
  std::uint32_t max_nodes = 1u << 16;
  std::uint32_t max_joints = 1u << 12;
  std::uint64_t max_keys = 1ull << 22;   ///< over all channels of all clips
  std::uint64_t max_poses = 1ull << 25;  ///< bones x keys of all clips, sampled (clip.h) at 30 Hz at least
  std::uint64_t max_image_pixels = 1ull << 26;
};

/// Reads a .glb, or a .gltf with buffers and images in its folder (or below) or as data URIs.
/// Takes Draco, KHR_mesh_quantization, any index width or none, interleaved, sparse and normalised
/// accessors, more than four influences (the four largest, renormalised, told in `warnings`),
/// triangle strips and fans, clips of every interpolation. Faces keep their order, faces of zero
/// area stay (but not the stitches of strips). What the default scene shows is read.
/// A mesh whose node mirrors (negative determinant) has its winding turned back.
/// Missing normals are made (area-weighted over equal positions). Materials and images that no
/// triangle uses are left out.
///
/// @throws InputError with a JSON pointer for whatever is malformed, out of range, or beyond
/// `options`; SystemError if the file can't be read. Never reads outside the file's own folder.
RawAsset readGltf(const std::filesystem::path& file, const GltfReadOptions& options = {});

/// The same for a GLB in memory; `name` stands for the file in messages. External URIs are refused.
RawAsset readGlb(std::span<const std::byte> bytes, const std::string& name,
                 const GltfReadOptions& options = {});

struct GlbWriteOptions {
  bool draco = false;  ///< KHR_draco_mesh_compression, sequential: numbers of vertices and faces stay
  int draco_position_bits = 16;
  int draco_normal_bits = 10;
  int draco_uv_bits = 12;
};

/// A GLB of the asset that the Khronos validator accepts without error. The same asset and options
/// give the same bytes. Primitives keep the order of vertices and faces exactly; indices are 16-bit
/// where they fit; `_TEMPLATE_VERTEX` is written as FLOAT and never quantised. Unused materials and
/// images are left out. One skin serves all meshes. Channels are written as they are.
/// @pre indices are in range, normals and weights normalised, names valid UTF-8.
std::vector<std::byte> writeGlb(const RawAsset& asset, const GlbWriteOptions& options = {});

}  // namespace ensemble
