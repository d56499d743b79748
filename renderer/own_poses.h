// Where the poses of people between key frames lie: all that somebody wears side by side, for one frame. Pure
// bookkeeping; the vertices themselves are PosePool's.
#pragma once

#include <cstdint>
#include <vector>

namespace ensemble {

/// A person's vertices, anywhere in the buffers.
struct OwnPose {
  std::uint32_t buffer = 0, first_vertex = 0;
  bool is_new = false;  ///< its vertices are to be written
};

/// Fills buffers one after the other, from the first anew in each frame.
class OwnPoses {
 public:
  OwnPoses(std::uint32_t people, std::uint32_t buffer_vertices)
      : buffer_vertices_(buffer_vertices), poses_(people) {}

  void beginFrame();
  /// @param vertex_count the same for a person throughout a frame, at most a buffer's
  OwnPose require(std::uint32_t person, std::uint32_t vertex_count);

  std::uint64_t vertexCount() const { return vertex_count_; }  ///< since beginFrame
  std::uint32_t count() const { return count_; }               ///< people, likewise

 private:
  struct Entry {
    std::uint32_t buffer = 0, first = 0;
    std::uint64_t frame = 0;
  };
  std::uint32_t buffer_vertices_;
  std::vector<Entry> poses_;
  std::uint64_t frame_ = 1, vertex_count_ = 0;
  std::uint32_t buffer_ = 0, next_vertex_ = 0, count_ = 0;
};

}  // namespace ensemble
