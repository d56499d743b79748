// The work of the compute rasteriser: people who show one index list in one pose are drawn together, run of
// triangles by run of triangles. Some may be drawn in a second round, for which the device picks those that
// are not hidden (occlusion_pass.h). No Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "shaders/shared/raster_types.h"

namespace ensemble {

/// A sub-mesh as the plan sees it.
struct PlanItem {
  std::uint32_t mesh = 0;
  std::uint32_t state = 0;  ///< what is bound to draw it: a number of the caller's
  /// What follows from the item: indices and triangles, and all that lets triangles be discarded.
  GpuRasterWork work{};
};

/// An item that a combination shows, and the number of its first face in who wears it.
struct ShownItem {
  std::uint32_t item = 0, first_face = 0;
};

/// Somebody to draw.
struct PlanPerson {
  std::uint32_t combination = 0;
  std::uint32_t key = 0;  ///< who have the same are in the same pose
  bool is_late = false;   ///< of the second round
};

/// Groups that are drawn with the same things bound.
struct PlanBatch {
  std::uint32_t state = 0, pose_buffer = 0;
  bool is_late = false;
  std::uint32_t first_group = 0, group_count = 0;
};

/// Where a mesh's pose at a key lies; asked once for each that is drawn.
struct PlanPose {
  std::uint32_t buffer = 0, first_vertex = 0;
};

class RasterPlan {
 public:
  /// @param shown per combination, ascending first_face @param triangles_per_group at least 1
  RasterPlan(std::vector<PlanItem> items, std::vector<std::vector<ShownItem>> shown,
             std::uint32_t triangles_per_group);

  /// First step: what there is to draw, for people in the order of their ids. Needs no poses.
  /// @param key_count all keys are below it
  void arrange(std::span<const PlanPerson> people, std::uint32_t key_count, std::uint32_t face_bits);
  /// Second step: where its poses are, in groups and batches. `pose_of(mesh, key)` gives a PlanPose.
  template <class PoseOf>
  void place(const PoseOf& pose_of) {
    for (std::uint32_t w = 0; w < work_.size(); ++w) {
      const PlanPose pose = pose_of(work_from_[w].mesh, work_from_[w].key);
      work_[w].pose = pose.first_vertex;
      work_batch_[w].pose_buffer = pose.buffer;
    }
    finishWork();
  }
  /// Groups that place() makes of what was arranged; of these the second round's.
  std::uint64_t groupCount() const { return group_count_; }
  std::uint64_t lateGroupCount() const { return late_group_count_; }

  const std::vector<std::uint32_t>& entries() const { return entries_; }
  const std::vector<GpuRasterWork>& work() const { return work_; }
  /// Those of the second round behind the others.
  const std::vector<GpuRasterGroup>& groups() const { return groups_; }
  std::uint32_t firstLateGroup() const { return first_late_group_; }
  bool hasSecondRound() const { return first_late_group_ < groups_.size(); }
  /// Room behind the entries for those that the device picks.
  std::uint64_t pickedCount() const { return picked_count_; }
  /// Those of the second round behind the others.
  const std::vector<PlanBatch>& batches() const { return batches_; }
  std::uint64_t triangleCount() const { return triangle_count_; }           ///< of all people
  std::uint64_t lateTriangleCount() const { return late_triangle_count_; }  ///< of these: the second round's
  /// Bits that number the faces of any one person.
  std::uint32_t faceBits() const { return face_bits_; }

 private:
  /// People of one key and round, in by_key_.
  struct Block {
    std::uint32_t key = 0, first = 0, count = 0;
  };
  void sortByKey(std::span<const PlanPerson> people, std::uint32_t key_count);
  void beginWork();
  /// Entries of all people of a block, item by item; touched_ are its items, with ranges in entry_first_ ...
  void gather(const Block& block, std::span<const PlanPerson> people, std::uint32_t face_bits);
  void addWork(std::uint32_t item, std::uint32_t key, bool is_late);
  void finishWork();

  std::vector<PlanItem> items_;
  std::vector<std::vector<ShownItem>> shown_;
  std::uint32_t triangles_per_group_ = 1, face_bits_ = 1;

  std::vector<std::uint32_t> key_cursors_, by_key_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> touched_, item_first_, item_count_;  // of the block at hand, per item
  std::vector<std::uint32_t> entries_;
  std::vector<GpuRasterWork> work_;
  struct MeshAtKey {
    std::uint32_t mesh = 0, key = 0;
  };
  std::vector<MeshAtKey> work_from_;   // per work item
  std::vector<PlanBatch> work_batch_;  // per work item: its buffers
  std::vector<GpuRasterGroup> groups_;
  std::vector<PlanBatch> batches_;
  std::uint32_t first_late_group_ = 0;
  std::uint64_t picked_count_ = 0, group_count_ = 0, late_group_count_ = 0;
  std::uint64_t triangle_count_ = 0, late_triangle_count_ = 0;
};

}  // namespace ensemble
