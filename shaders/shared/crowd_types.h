// What the crowd's shaders and the renderer share: structures, bindings, constants. Compiled by C++
// and GLSL; a test holds the offsets against the compiled shaders' own reflection.
#ifndef ENSEMBLE_SHADERS_SHARED_CROWD_TYPES_H
#define ENSEMBLE_SHADERS_SHARED_CROWD_TYPES_H

// Descriptor sets: one view's constants and shadow map; one chunk of people with one pass's queues;
// the scene's materials, with the faces of one mesh chunk; one texture array with one sampler.
#define ENSEMBLE_SET_VIEW 0
#define ENSEMBLE_SET_CROWD 1
#define ENSEMBLE_SET_ASSETS 2
#define ENSEMBLE_SET_TEXTURE 3
// The environment's shaders have the view's set too, and then their own texture array.
#define ENSEMBLE_SET_ENVIRONMENT_TEXTURE 1

#define ENSEMBLE_BINDING_VIEW 0
#define ENSEMBLE_BINDING_SHADOW_MAP 1

#define ENSEMBLE_BINDING_CHARACTERS 0
#define ENSEMBLE_BINDING_PALETTE 1
#define ENSEMBLE_BINDING_QUEUE 2
#define ENSEMBLE_BINDING_DRAWS 3

#define ENSEMBLE_BINDING_MATERIALS 0
#define ENSEMBLE_BINDING_TINTS 1
#define ENSEMBLE_BINDING_HIDDEN_FIRST 2
#define ENSEMBLE_BINDING_HIDDEN_WORDS 3
#define ENSEMBLE_BINDING_SOURCE_FACES 4

// The pose pass has a set of its own.
#define ENSEMBLE_BINDING_POSE_CHARACTERS 0
#define ENSEMBLE_BINDING_POSE_PALETTE 1
#define ENSEMBLE_BINDING_POSE_CLIPS 2
#define ENSEMBLE_BINDING_POSE_ANIMATION 3
#define ENSEMBLE_BINDING_POSE_QUEUE 4
#define ENSEMBLE_BINDING_POSE_LEGS 5
#define ENSEMBLE_BINDING_POSE_LEG_GROUPS 6
#define ENSEMBLE_BINDING_POSE_HEAD 7

// The post pass: the resolved linear picture in, the sRGB picture out.
#define ENSEMBLE_BINDING_POST_LINEAR 0
#define ENSEMBLE_BINDING_POST_SRGB 1

// Specialisation constants of the fragment shaders.
#define ENSEMBLE_CONSTANT_TEXTURED 0
#define ENSEMBLE_CONSTANT_CUT_OUT 1
#define ENSEMBLE_CONSTANT_HIDE_FACES 2

// Outputs of the AOV pass.
#define ENSEMBLE_AOV_CHARACTER 0
#define ENSEMBLE_AOV_REGION 1
#define ENSEMBLE_AOV_FACE 2
#define ENSEMBLE_AOV_DEPTH 3
#define ENSEMBLE_AOV_NORMAL 4

// Texels of a row of the animation texture: a multiple of 3, so that a matrix stays in one row.
#define ENSEMBLE_ANIMATION_WIDTH 3072

// Invocations that share a character in the pose pass.
#define ENSEMBLE_POSE_GROUP 64
// Groups along x of any dispatch: every Vulkan device has as many.
#define ENSEMBLE_MOST_GROUPS_X 65535u

// Pixels side by side, and rows, of a group of the post pass.
#define ENSEMBLE_POST_GROUP 64
#define ENSEMBLE_POST_ROWS 16

// On the device a vertex's first joint has the number of its garment part in the bits from here on.
#define ENSEMBLE_JOINT_BITS 13
// Where a draw's number goes on to fragments the part follows from this bit on.
#define ENSEMBLE_DRAW_BITS 24

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

#include "core/math.h"

namespace ensemble {
using uint = std::uint32_t;
using vec4 = glm::vec4;
using mat4 = glm::mat4;
#endif

/// One person (design 5).
struct GpuCharacter {
  vec4 world_from_model[3];  ///< rows
  uint clip;                 ///< into the clips
  float phase;               ///< part of the clip that has run at this frame, 0 .. 1
  uint combination;          ///< into the table of hidden faces
  uint tint_seed;
  uint first_joint;  ///< its first matrix in the palette
  uint number;       ///< in the whole crowd
  uint idle_clip;    ///< blended in by idle_weight
  float idle_phase;
  vec4 feet[2];       ///< x, z: what the ankle is moved by, model space; y: the sole's turn; w: 1 where held
  float idle_weight;  ///< 0 .. 1
  uint unused_0;
  uint unused_1;
  uint unused_2;
};

/// Somebody whose pose is to be computed.
struct GpuPoseJob {
  uint character;
  uint key_matrix;  ///< 0: as the clips run; else 1 + the first matrix of the key frame that is shown
};

/// How many they are, and the groups that the pose pass is dispatched with.
struct GpuPoseHead {
  uint count;
  uint groups_x;  ///< VkDispatchIndirectCommand
  uint groups_y;
  uint groups_z;
};

/// A clip in the animation texture. Texel 3 * (first_matrix + key * joint_count + joint) + row.
struct GpuClip {
  uint first_matrix;
  uint key_count;
  uint joint_count;
  uint legs;  ///< into the table of legs
};

/// A template's legs in the bind pose, model space (core/gait.h).
struct GpuLegs {
  vec4 positions[6];  ///< hip, knee, ankle of the left leg, then of the right
  uint joints[6];     ///< likewise
  uint first_group;   ///< of its joints in the table of groups (leg_ik.h)
  uint unused_0;
};

/// One instanced draw: what gl_DrawID stands for.
struct GpuDraw {
  uint material;
  uint region;       ///< AOV number, 1 and up
  uint first_face;   ///< into the source faces of its mesh chunk
  uint face_offset;  ///< added to what stands there
  uint is_covered;   ///< 1: hidden, and drawn by naive all the same; it casts no shadow
};

struct GpuMaterial {
  vec4 base_color;  ///< linear
  vec4 tint;        ///< rgb: 1 / the colour that a tint replaces; a: how far it does, 0 .. 1
  uint tint_first;  ///< its tints in the table of tints: first, count
  uint tint_count;
  uint tint_key;  ///< hashed with a person's tint seed
  uint texture_layer;
  float alpha_cutoff;
  float tint_spread;      ///< brightness varies by +- this part
  float sheen;            ///< strength of the light along silhouettes
  uint lower_tint_count;  ///< of these, for all parts but the topmost; 0: parts are not told apart
};

/// The material of a piece of the environment: push constants.
struct GpuStaticMaterial {
  vec4 base_color;  ///< linear
  float alpha_cutoff;
  uint texture_layer;
};

/// One view's constants, std140.
struct GpuView {
  mat4 clip_from_world;
  mat4 shadow_from_world;  ///< clip space of the shadow map
  vec4 camera;             ///< xyz: position, metres; w: near plane
  vec4 ray_origin;         ///< xyz: view ray of pixel (0, 0)'s corner; w: metres to fully faded
  vec4 ray_x;              ///< what a pixel to the right adds to it; w: 1 with shadows
  vec4 ray_y;              ///< what a pixel down adds to it; w: side of a shadow texel, metres
  vec4 to_sun;             ///< unit; w: size of the shadow map, texels
  vec4 sun_color;          ///< linear; w: 1 draws the sky's gradient, 0 its horizon everywhere
  vec4 ambient_up;         ///< linear light from above; w: alpha of the background
  vec4 ambient_down;       ///< linear light from below; w: the picture's column at the target's left edge
  vec4 horizon;            ///< linear; distance fades into it; w: the picture's row at the target's top
  vec4 zenith;             ///< linear
};

#ifdef __cplusplus
static_assert(sizeof(GpuCharacter) == 128 && offsetof(GpuCharacter, clip) == 48 &&
              offsetof(GpuCharacter, phase) == 52 && offsetof(GpuCharacter, combination) == 56 &&
              offsetof(GpuCharacter, tint_seed) == 60 && offsetof(GpuCharacter, first_joint) == 64 &&
              offsetof(GpuCharacter, number) == 68 && offsetof(GpuCharacter, feet) == 80 &&
              offsetof(GpuCharacter, idle_weight) == 112);
static_assert(sizeof(GpuLegs) == 128 && offsetof(GpuLegs, joints) == 96 &&
              offsetof(GpuLegs, first_group) == 120);
static_assert(sizeof(GpuPoseHead) == 16 && offsetof(GpuPoseHead, groups_x) == 4);
static_assert(sizeof(GpuClip) == 16 && offsetof(GpuClip, joint_count) == 8);
static_assert(sizeof(GpuDraw) == 20 && offsetof(GpuDraw, is_covered) == 16);
static_assert(sizeof(GpuMaterial) == 64 && offsetof(GpuMaterial, tint) == 16 &&
              offsetof(GpuMaterial, tint_first) == 32 && offsetof(GpuMaterial, texture_layer) == 44 &&
              offsetof(GpuMaterial, alpha_cutoff) == 48 && offsetof(GpuMaterial, sheen) == 56);
static_assert(offsetof(GpuStaticMaterial, alpha_cutoff) == 16 &&
              offsetof(GpuStaticMaterial, texture_layer) == 20);
static_assert(sizeof(GpuView) == 288 && offsetof(GpuView, shadow_from_world) == 64 &&
              offsetof(GpuView, camera) == 128 && offsetof(GpuView, zenith) == 272);
}  // namespace ensemble
#endif
#endif
