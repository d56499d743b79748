// What the compute rasteriser's shaders and the renderer share: structures, bindings, constants. Compiled by
// C++ and GLSL, as crowd_types.h.
#ifndef ENSEMBLE_SHADERS_SHARED_RASTER_TYPES_H
#define ENSEMBLE_SHADERS_SHARED_RASTER_TYPES_H

#include "shaders/shared/crowd_types.h"

// The rasteriser's own set, beside those of the view, the assets and the textures.
#define ENSEMBLE_SET_RASTER 1
// In place of the textures: the images of the AOVs.
#define ENSEMBLE_SET_RASTER_AOVS 3

#define ENSEMBLE_BINDING_RASTER_PEOPLE 0
#define ENSEMBLE_BINDING_RASTER_WHO 1
#define ENSEMBLE_BINDING_RASTER_ENTRIES 2
#define ENSEMBLE_BINDING_RASTER_WORK 3
#define ENSEMBLE_BINDING_RASTER_GROUPS 4
#define ENSEMBLE_BINDING_RASTER_TARGET 5
#define ENSEMBLE_BINDING_RASTER_INDICES 6
#define ENSEMBLE_BINDING_RASTER_POSES 7
#define ENSEMBLE_BINDING_RASTER_VERTICES 8
#define ENSEMBLE_BINDING_RASTER_ITEMS 9
#define ENSEMBLE_BINDING_RASTER_SHOWN 10
#define ENSEMBLE_BINDING_RASTER_POSE_TABLE 11
#define ENSEMBLE_BINDING_RASTER_MATERIALS 12
#define ENSEMBLE_BINDING_RASTER_TINTS 13
#define ENSEMBLE_BINDING_RASTER_PIXELS 14
#define ENSEMBLE_BINDING_RASTER_BINS 15
#define ENSEMBLE_BINDING_RASTER_DEPTH 16
#define ENSEMBLE_BINDING_RASTER_PICTURE 17
// With several samples: their colours as the graphics pipeline drew them, and as shaded here.
#define ENSEMBLE_BINDING_RASTER_DRAWN 18
#define ENSEMBLE_BINDING_RASTER_SHADED 19
// The target and the list of pixels again, for passes that only read them.
#define ENSEMBLE_BINDING_RASTER_SEEN 20
#define ENSEMBLE_BINDING_RASTER_LISTED 21

// The pass that skins poses has a set of its own.
#define ENSEMBLE_BINDING_SKIN_JOBS 0
#define ENSEMBLE_BINDING_SKIN_GROUPS 1
#define ENSEMBLE_BINDING_SKIN_VERTICES 2
#define ENSEMBLE_BINDING_SKIN_POSES 3
// And one for where its matrices come from.
#define ENSEMBLE_BINDING_SKIN_ANIMATION 0
#define ENSEMBLE_BINDING_SKIN_PALETTE 1
// The pass that mixes kept poses has, beside the first of these, a set for each of the two buffers it reads.
#define ENSEMBLE_BINDING_MIX_POSES 0

// The passes that find out whom the first round hides have one, too.
#define ENSEMBLE_BINDING_OCCLUSION_SEEN 0
#define ENSEMBLE_BINDING_OCCLUSION_DEPTH 1
#define ENSEMBLE_BINDING_OCCLUSION_PYRAMID 2
#define ENSEMBLE_BINDING_OCCLUSION_OCCLUDEES 3
#define ENSEMBLE_BINDING_OCCLUSION_BOXES 4
#define ENSEMBLE_BINDING_OCCLUSION_ENTRIES 5
#define ENSEMBLE_BINDING_OCCLUSION_WORK 6
#define ENSEMBLE_BINDING_OCCLUSION_GROUPS 7
#define ENSEMBLE_BINDING_OCCLUSION_BATCHES 8

// Specialisation constants of the rasteriser.
#define ENSEMBLE_CONSTANT_LANES 3
#define ENSEMBLE_CONSTANT_TO_SUN 4
#define ENSEMBLE_CONSTANT_SAMPLES 5
#define ENSEMBLE_CONSTANT_SHADOWS 6
#define ENSEMBLE_CONSTANT_COUNTS 7
// Of the pyramid's first level: what the graphics pipeline drew hides people, too.
#define ENSEMBLE_CONSTANT_DRAWN 3
// Of the pass that skins poses: people's own, from the palette, instead of those at key frames.
#define ENSEMBLE_CONSTANT_OWN_POSES 0

// Bits of a sub-pixel coordinate, as graphics pipelines have them.
#define ENSEMBLE_SUBPIXEL_BITS 8
// Triangles of a run, for each lane of a group.
#define ENSEMBLE_RASTER_RUN 16u
// Invocations of a group that skins, and the vertices that they do.
#define ENSEMBLE_SKIN_GROUP 64
#define ENSEMBLE_SKIN_RUN 512u
// Passes over pixels: invocations of a group, and pixels of an invocation: neighbours where they are listed,
// a group apart where they are shaded. Where shaders run on the CPU an invocation costs as much to begin as a
// simple pixel.
#define ENSEMBLE_LIST_GROUP 64
#define ENSEMBLE_LIST_RUN 16
#define ENSEMBLE_GROUP_PIXELS (ENSEMBLE_LIST_GROUP * ENSEMBLE_LIST_RUN)
// In place of a group's work: there is none.
#define ENSEMBLE_NO_WORK 0xffffffffu
// Samples that are listed and shaded at a time.
#define ENSEMBLE_RASTER_BAND (1u << 20)
// In a listed pixel: its number in the target, and which of its samples it is for.
#define ENSEMBLE_LISTED_PIXEL_BITS 28
// In a listed pixel: the item's number; above it the bin's.
#define ENSEMBLE_LISTED_ITEM_BITS 20

// The depth pyramid: pixels along a side of a texel of its first level, and how many levels there are.
#define ENSEMBLE_PYRAMID_TILE 8u
#define ENSEMBLE_PYRAMID_LEVELS 5u
// Texels of a GpuOccludee.
#define ENSEMBLE_OCCLUDEE_TEXELS 4
// Invocations of a group of the passes around it.
#define ENSEMBLE_OCCLUSION_GROUP 64

// A kept vertex: 15 bits each for x, y, z in the box of its clip, 10 and 9 for the octahedral normal.
#define ENSEMBLE_POSE_POSITION_BITS 15
#define ENSEMBLE_POSE_NORMAL_X_BITS 10
#define ENSEMBLE_POSE_NORMAL_Y_BITS 9
// Where a pose lies: its first vertex in the low bits, above them the number of its buffer.
#define ENSEMBLE_POSE_OFFSET_BITS 23
// Somebody has a pose of its own, and where it lies stands in the other bits.
#define ENSEMBLE_OWN_POSE 0x80000000u

// Texels of a person in the table of people: rows to the screen, then rows to the world.
#define ENSEMBLE_PERSON_TEXELS 6
// Texels of an item in the table of items.
#define ENSEMBLE_RASTER_ITEM_TEXELS 2

#ifdef __cplusplus
namespace ensemble {
#endif

/// A person that is rasterised in compute. From here on `kept` positions are whole numbers, as poses hold
/// them.
struct GpuRasterPerson {
  vec4 screen_from_kept[3];  ///< rows: x and y in sub-pixels, times w; w. To the sun: x, y; depth
  vec4 world_from_kept[3];   ///< rows
};

/// The rest about the same person.
struct GpuRasterWho {
  uint combination;
  uint pose;  ///< key of the person's wardrobe; or ENSEMBLE_OWN_POSE
  uint tint_seed;
  uint number;  ///< in the whole crowd
};

/// A sub-mesh as the compute rasteriser draws it; two texels.
struct GpuRasterItem {
  uint first_index;
  uint first_vertex;  ///< of its mesh, in its buffer
  uint first_pose;    ///< of its mesh, in the table of poses; a key is added
  uint bin;           ///< which buffers and textures it needs
  uint material;
  uint region;
  uint first_face;
  uint face_offset;
};

/// One index list in one pose, and the people who show it so.
struct GpuRasterWork {
  uint first_index;
  uint triangle_count;
  uint pose;  ///< first vertex in its buffer
  uint first_entry;
  uint entry_count;
  uint is_double_sided;
  // For what discards: hidden faces and cut-outs.
  uint first_face;    ///< into the source faces
  uint first_vertex;  ///< of the mesh, in its buffer
  uint material;
  uint batch;         ///< that its groups belong to
  uint first_box;     ///< GpuRunBox of its first run in the first clip; then by clip, then by run
  uint first_picked;  ///< of the second round: where entries are written that are left, group by group
};

/// A run of triangles of a work item, and people who show it: what one group draws.
struct GpuRasterGroup {
  uint work;  ///< or ENSEMBLE_NO_WORK
  uint first_triangle;
  uint first_entry;
  uint entry_count;
};

/// Somebody of the second round: where its boxes come to lie.
struct GpuOccludee {
  vec4 screen_from_model[3];  ///< rows: x and y in pixels, times w; w
  uint clip;                  ///< of its wardrobe
  uint idle_clip;             ///< likewise; its boxes are those of both
  uint clip_count;            ///< of its wardrobe
  uint is_tested;             ///< 0: no box holds it, and it is always drawn
};

/// What holds a run of triangles in a clip, model space.
struct GpuRunBox {
  vec4 low;
  vec4 high;
};

/// A batch of the second round: how many groups and triangles there are left. Behind the last batch one more,
/// whose group_count is the number of people hidden.
struct GpuRasterBatch {
  uint first_group;
  uint group_count;
  uint triangle_count;
  uint unused;
  uint groups_x;  ///< VkDispatchIndirectCommand
  uint groups_y;
  uint groups_z;
  uint unused_1;
};

/// A mesh to be skinned, at a key or as somebody's own; or to be mixed from two that are kept.
struct GpuSkinJob {
  vec4 box;  ///< xyz: low corner of the clip's box, or in the world, metres; w: steps a metre. Mixed: x, part
             ///< of the way from the one pose to the other
  uint first_vertex;  ///< of the mesh. Mixed: of the pose before
  uint vertex_count;
  uint pose;          ///< first vertex in its buffer
  uint first_matrix;  ///< of the key in the animation texture, or of the person in the palette. Mixed: first
                      ///< vertex of the pose after
};

/// A run of vertices of a job.
struct GpuSkinGroup {
  uint job;
  uint first_vertex;
};

/// Pixels that show items of one bin.
struct GpuRasterBin {
  uint count;
  uint first;   ///< in the sorted list
  uint cursor;  ///< while they are sorted
  uint unused_0;
  uint groups_x;  ///< VkDispatchIndirectCommand
  uint groups_y;
  uint groups_z;
  uint unused_1;
};

#ifdef __cplusplus
static_assert(sizeof(GpuRasterPerson) == 96 && sizeof(GpuRasterWho) == 16 && sizeof(GpuRasterItem) == 32);
static_assert(sizeof(GpuRasterPerson) == 16 * ENSEMBLE_PERSON_TEXELS);
static_assert(sizeof(GpuRasterItem) == 16 * ENSEMBLE_RASTER_ITEM_TEXELS);
static_assert(sizeof(GpuRasterWork) == 48 && sizeof(GpuRasterGroup) == 16);
static_assert(sizeof(GpuOccludee) == 16 * ENSEMBLE_OCCLUDEE_TEXELS && sizeof(GpuRunBox) == 32 &&
              sizeof(GpuRasterBatch) == 32);
static_assert(ENSEMBLE_LIST_RUN <= 32);  // bits of a mask, one for each pixel of a run
static_assert(sizeof(GpuSkinJob) == 32 && offsetof(GpuSkinJob, first_vertex) == 16);
static_assert(sizeof(GpuRasterBin) == 32 && offsetof(GpuRasterBin, groups_x) == 16);
}  // namespace ensemble
#endif
#endif
