// Where skinned vertices are kept from frame to frame: which poses are there, and where. Pure bookkeeping;
// the vertices themselves are PosePool's.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <unordered_map>
#include <vector>

namespace ensemble {

struct PoseCacheLimits {
  std::uint64_t budget_vertices = 0;         ///< that may stay from one frame to the next
  std::uint32_t buffer_vertices = 1u << 23;  ///< of one buffer; what is kept lies in several of them
};

struct PoseCacheStats {
  std::uint64_t hits = 0, misses = 0;  ///< poses asked for since the last beginFrame: kept; made anew
  std::uint64_t kept_vertices = 0;     ///< now
};

/// A mesh at a key, anywhere in the buffers.
struct KeptPose {
  std::uint32_t buffer = 0, first_vertex = 0;
  bool is_new = false;  ///< its vertices are to be written
};

/// Poses by number. Within a frame all that were asked for are kept, whatever the budget says; beyond it,
/// those that were not asked for longest go first. The budget changes what is made anew, never what is drawn.
class PoseCache {
 public:
  explicit PoseCache(const PoseCacheLimits& limits) : limits_(limits) {}

  /// Drops what the budget does not hold.
  void beginFrame();
  /// Drops all.
  void clear();
  /// @param vertex_count always the same for a pose, at most a buffer's
  KeptPose require(std::uint32_t pose, std::uint32_t vertex_count);

  std::uint32_t bufferCount() const { return static_cast<std::uint32_t>(free_.size()); }
  const PoseCacheStats& stats() const { return stats_; }

 private:
  struct Entry {
    std::uint32_t buffer = 0, first = 0, count = 0;
    std::uint64_t frame = 0;
    std::list<std::uint32_t>::iterator use;
  };
  /// Of one buffer: first vertex to count.
  using FreeRanges = std::map<std::uint32_t, std::uint32_t>;

  bool place(Entry& entry);
  void dropOldest();

  PoseCacheLimits limits_;
  PoseCacheStats stats_;
  std::uint64_t frame_ = 0;
  std::unordered_map<std::uint32_t, Entry> entries_;
  std::list<std::uint32_t> by_use_;  // poses, the one not used for longest first
  std::vector<FreeRanges> free_;     // per buffer
};

}  // namespace ensemble
