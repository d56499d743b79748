// Several renderers of one scene, so that frames overlap: a device draws one frame at a time, and a software
// device (lavapipe) keeps one core busy for much of it.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/renderer.h"

namespace ensemble {

/// What all renderers of a pool load. It outlives the pool.
struct PoolScene {
  const Scene* scene = nullptr;
  std::span<const Wardrobe> wardrobes = {};      ///< one for each of the scene's
  const EnvironmentMesh* environment = nullptr;  ///< null where the scene names none
};

/// What `automaticRendererCount` decides by.
struct SequenceShape {
  bool is_on_cpu = false;
  unsigned cores = 1;
  std::size_t frames = 1;
  bool is_computed = false;  ///< at least half of the people are drawn by the compute rasteriser
};

/// How many renderers draw a sequence, by counts alone: on a GPU one. On a CPU one for each core, because the
/// vertices of the graphics pipeline keep one core busy, or one for each 4 where compute shaders draw, which
/// use all cores; at most 8, and at most one for every 4 frames, because a renderer has to be loaded first.
unsigned automaticRendererCount(const SequenceShape& shape);

/// The first renderer is made at once, the others by the threads that draw, once the first frame is drawn.
/// All keep one limit of memory together. Which of them draws a frame changes no byte of its picture.
class RendererPool {
 public:
  /// @throws as Renderer and Renderer::load
  RendererPool(const RendererOptions& options, const PoolScene& scene);

  /// How many renderers there may be; 1 before it is called. Before the first frame. @param count at least 1
  void allow(unsigned count);
  /// As automaticRendererCount says of these frames once the first is drawn, and no more than fill three
  /// quarters of the device's memory, by what that took.
  /// @param cores of the machine @returns the most that it may come to
  unsigned allowAutomatic(std::size_t frames, unsigned cores);

  /// Renderer::render of one view, from any thread; waits for a renderer. Where a renderer fails, the others
  /// are given up, for their memory, and the frame is drawn again by the one that stays, with a warning: an
  /// error that leaves is that of a renderer alone. One that can't be made is a warning, too.
  /// @throws as Renderer::render
  void draw(const View& view, double seconds, Picture& picture);

  // Of any of them: they are alike.
  const Crowd& crowd() const { return crowd_; }
  const AovNumbers& aovNumbers() const { return numbers_; }
  const std::string& deviceName() const { return device_name_; }
  bool isOnCpu() const { return is_on_cpu_; }
  /// How many there have been. @pre nobody draws, here and below
  std::size_t madeCount() const { return made_; }
  /// Of all that ever were, in the order in which they were made.
  std::vector<std::string> validationMessages() const;

 private:
  struct Member {
    std::size_t number = 0;
    std::unique_ptr<Renderer> renderer;
  };

  Member make(std::size_t number) const;
  Member take();
  void give(Member member);
  /// The first frame is drawn: its targets and caches are there, and tell what one renderer takes.
  void letGrow(const Renderer& first, const View& view, const FrameStats& stats);
  /// Makes another one while the lock is off.
  void grow(std::unique_lock<std::mutex>& lock);
  /// After a failure of `member`: has all others go, or this one where another has begun to, and then takes
  /// that. False: it was alone.
  bool standAlone(Member& member);
  void retire(Member member);  // under the lock
  void warnOfOneOnly(const std::string& why);

  RendererOptions options_;
  PoolScene scene_;
  Crowd crowd_;
  AovNumbers numbers_;
  std::string device_name_;
  bool is_on_cpu_ = false;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Member> idle_;
  std::size_t count_ = 1;  // idle, drawing, being made
  std::size_t allowed_ = 1, made_ = 1, next_number_ = 1;
  std::optional<SequenceShape> automatic_;
  bool may_grow_ = false, has_warned_ = false;
  std::map<std::size_t, std::vector<std::string>> messages_;  // of those who went
};

}  // namespace ensemble
