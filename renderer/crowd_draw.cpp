#include "renderer/crowd_draw.h"

namespace ensemble {

VertexCounter::VertexCounter(const gpu::Device& device, std::uint32_t pass_count) : was_used_(pass_count) {
  if (!device.hasPipelineStatistics()) return;
  pool_ = ENSEMBLE_VK(vk::raii::QueryPool(
      device.handle(),
      vk::QueryPoolCreateInfo{
          .queryType = vk::QueryType::ePipelineStatistics,
          .queryCount = pass_count,
          .pipelineStatistics = vk::QueryPipelineStatisticFlagBits::eVertexShaderInvocations}));
}

void VertexCounter::reset(const vk::raii::CommandBuffer& commands) {
  std::fill(was_used_.begin(), was_used_.end(), false);
  if (*pool_) commands.resetQueryPool(*pool_, 0, static_cast<std::uint32_t>(was_used_.size()));
}

void VertexCounter::begin(const vk::raii::CommandBuffer& commands, std::uint32_t pass) {
  if (*pool_) commands.beginQuery(*pool_, pass, {});
}

void VertexCounter::end(const vk::raii::CommandBuffer& commands, std::uint32_t pass) {
  if (*pool_) commands.endQuery(*pool_, pass);
  was_used_[pass] = true;
}

std::optional<std::uint64_t> VertexCounter::result(const gpu::Device& device, std::uint32_t pass) const {
  if (!*pool_) return std::nullopt;
  if (!was_used_[pass]) return 0;
  std::uint64_t count = 0;
  const vk::Device handle = *device.handle();
  // The variant that writes where it is told: the other one allocates.
  const vk::Result result = ENSEMBLE_VK(handle.getQueryPoolResults(
      *pool_, pass, 1, sizeof count, &count, sizeof count,
      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait, *device.handle().getDispatcher()));
  if (result != vk::Result::eSuccess)
    gpu::throwVulkanError(result, "getQueryPoolResults", __FILE__, __LINE__);
  return count;
}

}  // namespace ensemble
