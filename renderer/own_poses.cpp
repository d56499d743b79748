#include "renderer/own_poses.h"

#include "core/check.h"

namespace ensemble {

void OwnPoses::beginFrame() {
  ++frame_;
  vertex_count_ = 0;
  buffer_ = next_vertex_ = count_ = 0;
}

OwnPose OwnPoses::require(std::uint32_t person, std::uint32_t vertex_count) {
  ENSEMBLE_CHECK(vertex_count > 0 && vertex_count <= buffer_vertices_);
  Entry& entry = poses_[person];
  const bool is_new = entry.frame != frame_;
  if (is_new) {
    if (vertex_count > buffer_vertices_ - next_vertex_) {
      ++buffer_;
      next_vertex_ = 0;
    }
    entry = {buffer_, next_vertex_, frame_};
    next_vertex_ += vertex_count;
    vertex_count_ += vertex_count;
    ++count_;
  }
  return {entry.buffer, entry.first, is_new};
}

}  // namespace ensemble
