#include "assetpipe/transfer_clips.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr float kBoneTolerance = 0.01f;  // metres between bind positions

/// model_from_bone in the bind pose; for bones that are no joints, at rest.
std::vector<Mat4> bindPose(const RawSkeleton& skeleton) {
  std::vector<Mat4> model_from_bone(skeleton.bones.size());
  globalPose(skeleton, restPose(skeleton), model_from_bone);
  for (const RawJoint& joint : skeleton.joints)
    model_from_bone[joint.bone] = glm::inverse(joint.joint_from_model);
  return model_from_bone;
}

/// For each bone of `target` the bone of `source` that has its name, or -1.
std::vector<std::int32_t> matchBones(const RawSkeleton& target, const RawSkeleton& source) {
  std::map<std::string, std::int32_t> by_name;
  for (std::size_t b = 0; b < source.bones.size(); ++b) {
    by_name.try_emplace(source.bones[b].name, static_cast<std::int32_t>(b));
  }
  std::vector<std::int32_t> matched;
  for (const RawBone& bone : target.bones) {
    const auto found = by_name.find(bone.name);
    matched.push_back(found == by_name.end() ? -1 : found->second);
  }
  return matched;
}

void checkMovingBones(const RawAsset& asset, const RawClip& clip, const RawSkeleton& target,
                      const std::vector<std::int32_t>& matched, const std::string& file) {
  for (const RawChannel& channel : clip.channels) {
    const bool known =
        std::find(matched.begin(), matched.end(), static_cast<std::int32_t>(channel.bone)) != matched.end();
    const std::string& name = asset.skeleton.bones[channel.bone].name;
    if (known) continue;
    throw InputError({file, "/animations",
                      "clip '" + clip.name + "' moves '" + name + "', which the template's skeleton lacks",
                      "give clips of the template's own skeleton"});
  }
  const std::vector<Mat4> here = bindPose(target), there = bindPose(asset.skeleton);
  for (std::size_t b = 0; b < matched.size(); ++b) {
    if (matched[b] < 0) continue;
    const float distance =
        glm::distance(Vec3(here[b][3]), Vec3(there[static_cast<std::size_t>(matched[b])][3]));
    if (distance <= kBoneTolerance) continue;
    throw InputError({file, "/skins",
                      fmt::format("joint '{}' stands {:.1f} mm from the template's in the bind pose",
                                  target.bones[b].name, distance * 1000.0f),
                      "give clips of the template's own skeleton"});
  }
}

/// One pose of `source`'s bones as local transforms of `target`'s: every matched bone moves from
/// its bind pose as its namesake does; the others keep their rest pose under their parents.
void transferPose(const RawSkeleton& source, std::span<const Transform> source_local,
                  const RawSkeleton& target, const std::vector<std::int32_t>& matched,
                  std::span<Transform> target_local) {
  const std::vector<Mat4> source_bind = bindPose(source), target_bind = bindPose(target);
  std::vector<Mat4> source_now(source.bones.size()), target_now(target.bones.size());
  globalPose(source, source_local, source_now);
  for (std::size_t b = 0; b < target.bones.size(); ++b) {
    const std::int32_t parent = target.bones[b].parent;
    const Mat4 parent_now = parent < 0 ? Mat4(1.0f) : target_now[static_cast<std::size_t>(parent)];
    if (matched[b] < 0) {
      target_local[b] = target.bones[b].rest;
      target_now[b] = parent_now * toMatrix(target_local[b]);
      continue;
    }
    const auto s = static_cast<std::size_t>(matched[b]);
    target_now[b] = source_now[s] * glm::inverse(source_bind[s]) * target_bind[b];
    target_local[b] = toTransform(glm::inverse(parent_now) * target_now[b]);
  }
}

/// A name that no one chose: Mixamo's, and those of Blender's import ("Armature|mixamo.com|Layer0").
bool isMadeUp(const std::string& name) {
  return name.find("mixamo.com") != std::string::npos || name.find('|') != std::string::npos;
}

std::string freeName(const TemplateBody& body, const std::string& wanted, const std::string& stem) {
  const auto taken = [&](const std::string& name) {
    return name.empty() || std::any_of(body.clips.begin(), body.clips.end(),
                                       [&](const Clip& clip) { return clip.name == name; });
  };
  std::string name = taken(wanted) || isMadeUp(wanted) ? stem : wanted;
  for (int copy = 2; taken(name); ++copy) name = stem + "_" + std::to_string(copy);
  return name;
}

}  // namespace

void transferClips(const RawAsset& asset, const std::filesystem::path& file, TemplateBody& body) {
  if (asset.clips.empty()) {
    throw InputError(
        {file.string(), "/animations", "there is no clip in this file", "export it with its animation"});
  }
  const std::vector<std::int32_t> matched = matchBones(body.skeleton, asset.skeleton);
  for (const RawClip& raw : asset.clips) {
    checkMovingBones(asset, raw, body.skeleton, matched, file.string());
    const Clip source = sampleClip(asset.skeleton, raw);
    Clip clip;
    clip.name = freeName(body, source.name, file.stem().string());
    clip.seconds = source.seconds;
    clip.key_count = source.key_count;
    clip.transforms.resize(std::size_t{clip.key_count} * body.skeleton.bones.size());
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      transferPose(
          asset.skeleton, source.key(key), body.skeleton, matched,
          std::span(clip.transforms).subspan(key * body.skeleton.bones.size(), body.skeleton.bones.size()));
    }
    body.clips.push_back(std::move(clip));
  }
}

}  // namespace ensemble
