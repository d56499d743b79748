// Clips: from a file's channels to key frames at equal distances, and poses from those.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math.h"
#include "core/raw_asset.h"

namespace ensemble {

/// A clip as key frames at equal distances in time. The last key closes the loop: a looping clip's
/// last key equals its first.
struct Clip {
  std::string name;
  float seconds = 0.0f;         ///< from first key to last; 0 for a clip of one key
  std::uint32_t key_count = 0;  ///< at least 1
  float ground_speed = 0.0f;    ///< metres a second the figure would walk; 0 if it stands
  /// Local transforms, key_count by #bones, key-major.
  std::vector<Transform> transforms;

  std::span<const Transform> key(std::uint32_t index) const {
    const std::size_t bones = transforms.size() / key_count;
    return {transforms.data() + index * bones, bones};
  }
};

/// Samples a clip's channels at equal distances: at the file's own keys where these are equally
/// spaced (within 2 % of a step), else at 30 Hz. Bones without a channel stay at rest.
/// Rotations are interpolated on the shorter arc (slerp) and normalised. Time starts at the first key.
Clip sampleClip(const RawSkeleton& skeleton, const RawClip& clip);

/// The other way, for files: LINEAR channels; only those that differ from rest at some key, and at
/// least one, so that the clip keeps its length.
RawClip toRawClip(const RawSkeleton& skeleton, const Clip& clip);

/// world_from_bone of every bone, from local transforms (#bones each).
void globalPose(const RawSkeleton& skeleton, std::span<const Transform> local,
                std::span<Mat4> world_from_bone);

/// What skins a vertex: world_from_bone * joint_from_model of every joint, #joints, inverse bind
/// pose folded in (Lister equation 1).
std::vector<Mat4> skinningMatrices(const RawSkeleton& skeleton, std::span<const Transform> local);

/// Skinning matrices between key frames, interpolated as matrices (design 9): those of the renderer.
/// @param key from 0 on; what lies beyond the last key is the last key
std::vector<Mat4> skinningMatricesAt(const RawSkeleton& skeleton, const Clip& clip, float key);

/// a * (1 - part) + b * part of each of two poses. @pre as many in both
void mixMatrices(std::span<Mat4> a, std::span<const Mat4> b, float part);

/// The local transforms at rest, #bones.
std::vector<Transform> restPose(const RawSkeleton& skeleton);

/// A vertex's position under skinning matrices; where no joint moves it, its own. For tools and tests (the
/// renderer does it on the GPU).
Vec3 skinPosition(const RawVertex& vertex, std::span<const Mat4> skinning_matrices);
Vec3 skinPosition(const Vec3& position, const SkinBinding& skin, std::span<const Mat4> skinning_matrices);

}  // namespace ensemble
