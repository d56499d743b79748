// How long the device takes for each part of a frame, by timestamps. Does nothing where it has none.
#pragma once

#include "renderer/frame_stats.h"
#include "renderer/vk/device.h"

namespace ensemble {

class PartTimer {
 public:
  explicit PartTimer(const gpu::Device& device);

  /// Begins; outside of rendering.
  void begin(const vk::raii::CommandBuffer& commands) const;
  /// Ends the next part: all of them, in the order of FramePart, outside of rendering.
  void end(const vk::raii::CommandBuffer& commands, FramePart part) const;
  /// After the frame: adds milliseconds.
  void addTo(PartTimes& times) const;

 private:
  void write(const vk::raii::CommandBuffer& commands, std::uint32_t query) const;

  const gpu::Device& device_;
  vk::raii::QueryPool pool_ = nullptr;
};

}  // namespace ensemble
