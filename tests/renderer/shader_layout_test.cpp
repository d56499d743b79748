// The structures of shaders/shared/crowd_types.h as the compiled shaders lay them out.
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "shaders/shared/crowd_types.h"
#include "shaders/shared/queue_types.h"
#include "shaders/shared/raster_types.h"
#include "spirv/aov.frag.h"
#include "spirv/crowd.frag.h"
#include "spirv/crowd.vert.h"
#include "spirv/cull.comp.h"
#include "spirv/environment.frag.h"
#include "spirv/environment.vert.h"
#include "spirv/occlusion_pick.comp.h"
#include "spirv/pose.comp.h"
#include "spirv/pose_fill.comp.h"
#include "spirv/queue_draws.comp.h"
#include "spirv/raster.comp.h"
#include "spirv/raster_list.comp.h"
#include "spirv/shadow_discard.frag.h"
#include "spirv/skin_pose.comp.h"

namespace ensemble {
namespace {

/// What a SPIR-V module says of its structures. Word layout: SPIR-V specification, section 2.3.
struct Reflection {
  std::map<std::string, std::map<std::string, std::uint32_t>> offsets;  ///< by structure and member
  std::map<std::string, std::uint32_t> strides;                         ///< of runtime arrays, by element

  explicit Reflection(std::span<const std::uint32_t> words) {
    constexpr std::uint32_t kName = 5, kMemberName = 6, kDecorate = 71, kMemberDecorate = 72,
                            kRuntimeArray = 29;
    constexpr std::uint32_t kOffset = 35, kArrayStride = 6;
    std::map<std::uint32_t, std::string> names;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> members;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> member_offsets;
    std::map<std::uint32_t, std::uint32_t> array_strides, elements;
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
      const std::uint32_t* word = words.data() + at;
      const auto text = [&](std::size_t from) {
        return std::string(reinterpret_cast<const char*>(word + from));
      };
      switch (word[0] & 0xffffu) {
        case kName:
          names[word[1]] = text(2);
          break;
        case kMemberName:
          members[word[1]][word[2]] = text(3);
          break;
        case kMemberDecorate:
          if (word[3] == kOffset) member_offsets[word[1]][word[2]] = word[4];
          break;
        case kDecorate:
          if (word[2] == kArrayStride) array_strides[word[1]] = word[3];
          break;
        case kRuntimeArray:
          elements[word[1]] = word[2];
          break;
        default:
          break;
      }
    }
    for (const auto& [id, of_members] : member_offsets) {
      for (const auto& [member, offset] : of_members) offsets[names[id]][members[id][member]] = offset;
    }
    for (const auto& [array, element] : elements) strides[names[element]] = array_strides[array];
  }
};

TEST(ShaderLayout, CharactersAndClips) {
  const Reflection shader(kPoseComp);
  const auto& character = shader.offsets.at("GpuCharacter");
  EXPECT_EQ(character.at("world_from_model"), offsetof(GpuCharacter, world_from_model));
  EXPECT_EQ(character.at("clip"), offsetof(GpuCharacter, clip));
  EXPECT_EQ(character.at("phase"), offsetof(GpuCharacter, phase));
  EXPECT_EQ(character.at("combination"), offsetof(GpuCharacter, combination));
  EXPECT_EQ(character.at("tint_seed"), offsetof(GpuCharacter, tint_seed));
  EXPECT_EQ(character.at("first_joint"), offsetof(GpuCharacter, first_joint));
  EXPECT_EQ(character.at("number"), offsetof(GpuCharacter, number));
  EXPECT_EQ(shader.strides.at("GpuCharacter"), sizeof(GpuCharacter));
  const auto& clip = shader.offsets.at("GpuClip");
  EXPECT_EQ(clip.at("first_matrix"), offsetof(GpuClip, first_matrix));
  EXPECT_EQ(clip.at("key_count"), offsetof(GpuClip, key_count));
  EXPECT_EQ(clip.at("joint_count"), offsetof(GpuClip, joint_count));
  EXPECT_EQ(shader.strides.at("GpuClip"), sizeof(GpuClip));
}

TEST(ShaderLayout, CullingAndQueues) {
  const Reflection cull(kCullComp), draws(kQueueDrawsComp), poses(kPoseFillComp), pose_pass(kPoseComp);
  const auto& culling = cull.offsets.at("GpuCulling");
  EXPECT_EQ(culling.at("picture"), offsetof(GpuCulling, picture));
  EXPECT_EQ(culling.at("tile"), offsetof(GpuCulling, tile));
  EXPECT_EQ(culling.at("shadow_x"), offsetof(GpuCulling, shadow_x));
  EXPECT_EQ(culling.at("shadow_y"), offsetof(GpuCulling, shadow_y));
  EXPECT_EQ(culling.at("eye"), offsetof(GpuCulling, eye));
  EXPECT_EQ(culling.at("pixels"), offsetof(GpuCulling, pixels));
  EXPECT_EQ(culling.at("snap_squared"), offsetof(GpuCulling, snap_squared));
  EXPECT_EQ(culling.at("shadow_scale"), offsetof(GpuCulling, shadow_scale));
  EXPECT_EQ(culling.at("has_shadows"), offsetof(GpuCulling, has_shadows));
  EXPECT_EQ(culling.at("poses_casters"), offsetof(GpuCulling, poses_casters));
  EXPECT_EQ(cull.strides.at("GpuCharacter"), sizeof(GpuCharacter));
  EXPECT_EQ(cull.strides.at("GpuClip"), sizeof(GpuClip));
  const auto& item = draws.offsets.at("GpuQueueItem");
  EXPECT_EQ(item.at("vertex_offset"), offsetof(GpuQueueItem, vertex_offset));
  EXPECT_EQ(item.at("first_of_batch"), offsetof(GpuQueueItem, first_of_batch));
  EXPECT_EQ(item.at("draw"), offsetof(GpuQueueItem, draw));
  EXPECT_EQ(draws.strides.at("GpuQueueItem"), sizeof(GpuQueueItem));
  EXPECT_EQ(draws.strides.at("GpuQueueTotal"), sizeof(GpuQueueTotal));
  EXPECT_EQ(draws.strides.at("GpuQueueCommand"), sizeof(GpuQueueCommand));
  EXPECT_EQ(draws.strides.at("GpuDraw"), sizeof(GpuDraw));
  const auto& push = draws.offsets.at("GpuQueuePush");
  EXPECT_EQ(push.at("queue_count"), offsetof(GpuQueuePush, queue_count));
  EXPECT_EQ(push.at("verdict"), offsetof(GpuQueuePush, verdict));
  EXPECT_EQ(poses.strides.at("GpuPoseJob"), sizeof(GpuPoseJob));
  EXPECT_EQ(pose_pass.offsets.at("GpuPoseHead").at("count"), offsetof(GpuPoseHead, count));
}

TEST(ShaderLayout, DrawsAndMaterials) {
  const Reflection shader(kCrowdFrag);
  const auto& draw = shader.offsets.at("GpuDraw");
  EXPECT_EQ(draw.at("material"), offsetof(GpuDraw, material));
  EXPECT_EQ(draw.at("region"), offsetof(GpuDraw, region));
  EXPECT_EQ(draw.at("first_face"), offsetof(GpuDraw, first_face));
  EXPECT_EQ(draw.at("face_offset"), offsetof(GpuDraw, face_offset));
  EXPECT_EQ(draw.at("is_covered"), offsetof(GpuDraw, is_covered));
  EXPECT_EQ(shader.strides.at("GpuDraw"), sizeof(GpuDraw));
  const auto& material = shader.offsets.at("GpuMaterial");
  EXPECT_EQ(material.at("base_color"), offsetof(GpuMaterial, base_color));
  EXPECT_EQ(material.at("tint"), offsetof(GpuMaterial, tint));
  EXPECT_EQ(material.at("tint_first"), offsetof(GpuMaterial, tint_first));
  EXPECT_EQ(material.at("tint_count"), offsetof(GpuMaterial, tint_count));
  EXPECT_EQ(material.at("tint_key"), offsetof(GpuMaterial, tint_key));
  EXPECT_EQ(material.at("texture_layer"), offsetof(GpuMaterial, texture_layer));
  EXPECT_EQ(material.at("alpha_cutoff"), offsetof(GpuMaterial, alpha_cutoff));
  EXPECT_EQ(material.at("tint_spread"), offsetof(GpuMaterial, tint_spread));
  EXPECT_EQ(material.at("sheen"), offsetof(GpuMaterial, sheen));
  EXPECT_EQ(material.at("lower_tint_count"), offsetof(GpuMaterial, lower_tint_count));
  EXPECT_EQ(shader.strides.at("GpuMaterial"), sizeof(GpuMaterial));
}

TEST(ShaderLayout, TheEnvironment) {
  const Reflection fragment(kEnvironmentFrag), vertex(kEnvironmentVert), crowd(kCrowdFrag);
  const auto& material = fragment.offsets.at("GpuStaticMaterial");
  EXPECT_EQ(material.at("base_color"), offsetof(GpuStaticMaterial, base_color));
  EXPECT_EQ(material.at("alpha_cutoff"), offsetof(GpuStaticMaterial, alpha_cutoff));
  EXPECT_EQ(material.at("texture_layer"), offsetof(GpuStaticMaterial, texture_layer));
  EXPECT_EQ(fragment.offsets.at("GpuView"), crowd.offsets.at("GpuView"));
  EXPECT_EQ(vertex.offsets.at("GpuView"), crowd.offsets.at("GpuView"));
}

TEST(ShaderLayout, TheView) {
  const Reflection shader(kCrowdFrag);
  const auto& view = shader.offsets.at("GpuView");
  EXPECT_EQ(view.at("clip_from_world"), offsetof(GpuView, clip_from_world));
  EXPECT_EQ(view.at("shadow_from_world"), offsetof(GpuView, shadow_from_world));
  EXPECT_EQ(view.at("camera"), offsetof(GpuView, camera));
  EXPECT_EQ(view.at("ray_origin"), offsetof(GpuView, ray_origin));
  EXPECT_EQ(view.at("ray_x"), offsetof(GpuView, ray_x));
  EXPECT_EQ(view.at("ray_y"), offsetof(GpuView, ray_y));
  EXPECT_EQ(view.at("to_sun"), offsetof(GpuView, to_sun));
  EXPECT_EQ(view.at("sun_color"), offsetof(GpuView, sun_color));
  EXPECT_EQ(view.at("ambient_up"), offsetof(GpuView, ambient_up));
  EXPECT_EQ(view.at("ambient_down"), offsetof(GpuView, ambient_down));
  EXPECT_EQ(view.at("horizon"), offsetof(GpuView, horizon));
  EXPECT_EQ(view.at("zenith"), offsetof(GpuView, zenith));
}

// Every stage that shares a structure lays it out alike.
TEST(ShaderLayout, StagesAgree) {
  const Reflection fragment(kCrowdFrag), vertex(kCrowdVert), aov(kAovFrag), shadow(kShadowDiscardFrag),
      pose(kPoseComp);
  EXPECT_EQ(fragment.offsets.at("GpuView"), vertex.offsets.at("GpuView"));
  EXPECT_EQ(fragment.offsets.at("GpuView"), aov.offsets.at("GpuView"));
  EXPECT_EQ(fragment.offsets.at("GpuCharacter"), vertex.offsets.at("GpuCharacter"));
  EXPECT_EQ(fragment.offsets.at("GpuCharacter"), pose.offsets.at("GpuCharacter"));
  EXPECT_EQ(fragment.offsets.at("GpuDraw"), aov.offsets.at("GpuDraw"));
  EXPECT_EQ(fragment.offsets.at("GpuDraw"), shadow.offsets.at("GpuDraw"));
}

TEST(ShaderLayout, WorkOfTheComputeRasteriser) {
  const Reflection raster(kRasterComp), list(kRasterListComp), skin(kSkinPoseComp), pose(kPoseComp);
  const auto& work = raster.offsets.at("GpuRasterWork");
  EXPECT_EQ(work.at("triangle_count"), offsetof(GpuRasterWork, triangle_count));
  EXPECT_EQ(work.at("entry_count"), offsetof(GpuRasterWork, entry_count));
  EXPECT_EQ(work.at("is_double_sided"), offsetof(GpuRasterWork, is_double_sided));
  EXPECT_EQ(work.at("material"), offsetof(GpuRasterWork, material));
  EXPECT_EQ(raster.strides.at("GpuRasterWork"), sizeof(GpuRasterWork));
  EXPECT_EQ(raster.strides.at("GpuRasterGroup"), sizeof(GpuRasterGroup));
  EXPECT_EQ(list.offsets.at("GpuRasterBin").at("groups_x"), offsetof(GpuRasterBin, groups_x));
  EXPECT_EQ(list.strides.at("GpuRasterBin"), sizeof(GpuRasterBin));
  const Reflection pick(kOcclusionPickComp);
  EXPECT_EQ(pick.offsets.at("GpuRasterWork"), work);
  EXPECT_EQ(pick.offsets.at("GpuRasterGroup"), raster.offsets.at("GpuRasterGroup"));
  EXPECT_EQ(pick.strides.at("GpuRasterBatch"), sizeof(GpuRasterBatch));
  EXPECT_EQ(pick.offsets.at("GpuRasterBatch").at("groups_x"), offsetof(GpuRasterBatch, groups_x));
  const auto& job = skin.offsets.at("GpuSkinJob");
  EXPECT_EQ(job.at("first_vertex"), offsetof(GpuSkinJob, first_vertex));
  EXPECT_EQ(job.at("first_matrix"), offsetof(GpuSkinJob, first_matrix));
  EXPECT_EQ(skin.strides.at("GpuSkinJob"), sizeof(GpuSkinJob));
  EXPECT_EQ(skin.strides.at("GpuSkinGroup"), sizeof(GpuSkinGroup));
  EXPECT_EQ(pose.strides.at("GpuPoseJob"), sizeof(GpuPoseJob));
}

}  // namespace
}  // namespace ensemble
