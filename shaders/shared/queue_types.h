// What the shaders that cull people and build queues share with the renderer: structures, bindings,
// constants. Compiled by C++ and GLSL, as crowd_types.h.
#ifndef ENSEMBLE_SHADERS_SHARED_QUEUE_TYPES_H
#define ENSEMBLE_SHADERS_SHARED_QUEUE_TYPES_H

#include "shaders/shared/crowd_types.h"

// cull.comp: one chunk of people.
#define ENSEMBLE_BINDING_CULL_VIEW 0
#define ENSEMBLE_BINDING_CULL_CHARACTERS 1
#define ENSEMBLE_BINDING_CULL_CLIPS 2
#define ENSEMBLE_BINDING_CULL_BOUNDS 3
#define ENSEMBLE_BINDING_CULL_HEIGHTS 4
#define ENSEMBLE_BINDING_CULL_POSES 5
#define ENSEMBLE_BINDING_CULL_VERDICTS 6

// The queues of one chunk of people: of a pass, or of poses.
#define ENSEMBLE_BINDING_QUEUE_VERDICTS 0
#define ENSEMBLE_BINDING_QUEUE_COUNTS 1
#define ENSEMBLE_BINDING_QUEUE_TOTALS 2
#define ENSEMBLE_BINDING_QUEUE_ENTRIES 3
// A pass alone.
#define ENSEMBLE_BINDING_QUEUE_RANGES 4
#define ENSEMBLE_BINDING_QUEUE_SHOWN 5
#define ENSEMBLE_BINDING_QUEUE_ITEMS 6
#define ENSEMBLE_BINDING_QUEUE_COMMANDS 7
#define ENSEMBLE_BINDING_QUEUE_DRAWS 8
#define ENSEMBLE_BINDING_QUEUE_DRAW_COUNTS 9
// Poses alone.
#define ENSEMBLE_BINDING_QUEUE_POSES 10
#define ENSEMBLE_BINDING_QUEUE_POSE_HEAD 11

// People of a group, an invocation each; as many as every device can have.
#define ENSEMBLE_QUEUE_GROUP 128
#define ENSEMBLE_QUEUE_WORDS (ENSEMBLE_QUEUE_GROUP / 32)
// Queues whose masks of a group's people a group holds in shared memory at once: 8 KiB.
#define ENSEMBLE_QUEUE_RANGE 512
// The scan over groups: queues side by side, and parts that the groups are cut into.
#define ENSEMBLE_SCAN_QUEUES 16
#define ENSEMBLE_SCAN_PARTS 8

// A verdict on somebody: these bits, and above them the combination.
#define ENSEMBLE_VERDICT_SEEN 1u        // in the tile
#define ENSEMBLE_VERDICT_CASTS 2u       // into the shadow map
#define ENSEMBLE_VERDICT_POSE 4u        // to be posed: is in the tile
#define ENSEMBLE_VERDICT_CASTS_POSE 8u  // to be posed: casts, and is not in the tile
#define ENSEMBLE_VERDICT_IN_PICTURE 16u
#define ENSEMBLE_VERDICT_BITS 8
#define ENSEMBLE_MOST_COMBINATIONS (1u << (32 - ENSEMBLE_VERDICT_BITS))

// The queues of poses: of these bits, in this order. Who is in the picture is only counted.
#define ENSEMBLE_FIRST_POSE_BIT 2
#define ENSEMBLE_POSE_QUEUES 3
#define ENSEMBLE_COUNTED_POSE_QUEUE 2

#ifdef __cplusplus
namespace ensemble {
#endif

/// What people are culled by: std140.
struct GpuCulling {
  vec4 picture[5];  ///< planes, inside is >= 0
  vec4 tile[5];     ///< likewise
  vec4 shadow_x;    ///< rows of clip space of the shadow map
  vec4 shadow_y;
  vec4 eye;  ///< xyz: the camera; w: near plane squared
  float pixels;
  float snap_squared;
  float shadow_scale;  ///< of a length in the shadow map's clip space
  uint has_shadows;    ///< 0: nobody casts
  uint poses_casters;  ///< 1: casters are posed now
  uint unused_0;
  uint unused_1;
  uint unused_2;
};

/// A sub-mesh as it is drawn.
struct GpuQueueItem {
  uint index_count;
  uint first_index;
  int vertex_offset;
  uint batch;
  uint first_of_batch;  ///< item
  GpuDraw draw;
};

/// A queue once it was counted.
struct GpuQueueTotal {
  uint count;
  uint offset;  ///< of its first entry
  uint rank;    ///< queues before it that are not empty
};

/// VkDrawIndexedIndirectCommand
struct GpuQueueCommand {
  uint index_count;
  uint instance_count;
  uint first_index;
  int vertex_offset;
  uint first_instance;
};

/// What a queue is built with: push constants.
struct GpuQueuePush {
  uint person_count;
  uint group_count;
  uint queue_count;
  uint verdict;  ///< the bit of those who are queued
};

#ifdef __cplusplus
static_assert(sizeof(GpuCulling) == 240 && offsetof(GpuCulling, tile) == 80 &&
              offsetof(GpuCulling, shadow_x) == 160 && offsetof(GpuCulling, pixels) == 208 &&
              offsetof(GpuCulling, poses_casters) == 224);
static_assert(sizeof(GpuQueueItem) == 40 && offsetof(GpuQueueItem, draw) == 20);
static_assert(sizeof(GpuQueueTotal) == 12 && sizeof(GpuQueueCommand) == 20);
}  // namespace ensemble
#endif
#endif
