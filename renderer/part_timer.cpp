#include "renderer/part_timer.h"

#include <array>

namespace ensemble {
namespace {

constexpr std::uint32_t kQueryCount = kFramePartCount + 1;

}  // namespace

PartTimer::PartTimer(const gpu::Device& device) : device_(device) {
  if (!device.hasTimestamps()) return;
  pool_ = ENSEMBLE_VK(vk::raii::QueryPool(
      device.handle(),
      vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = kQueryCount}));
}

void PartTimer::write(const vk::raii::CommandBuffer& commands, std::uint32_t query) const {
  if (*pool_) commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *pool_, query);
}

void PartTimer::begin(const vk::raii::CommandBuffer& commands) const {
  if (*pool_) commands.resetQueryPool(*pool_, 0, kQueryCount);
  write(commands, 0);
}

void PartTimer::end(const vk::raii::CommandBuffer& commands, FramePart part) const {
  write(commands, static_cast<std::uint32_t>(part) + 1);
}

void PartTimer::addTo(PartTimes& times) const {
  if (!*pool_) return;
  std::array<std::uint64_t, kQueryCount> ticks{};
  const vk::Device handle = *device_.handle();
  // The variant that writes where it is told: the other one allocates.
  const vk::Result result = ENSEMBLE_VK(handle.getQueryPoolResults(
      *pool_, 0, kQueryCount, sizeof ticks, ticks.data(), sizeof ticks[0],
      vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait, *device_.handle().getDispatcher()));
  if (result != vk::Result::eSuccess)
    gpu::throwVulkanError(result, "getQueryPoolResults", __FILE__, __LINE__);
  const double milliseconds = double{device_.limits().timestampPeriod} * 1e-6;
  for (std::size_t part = 0; part < times.size(); ++part) {
    if (ticks[part + 1] > ticks[part])
      times[part] += static_cast<double>(ticks[part + 1] - ticks[part]) * milliseconds;
  }
}

}  // namespace ensemble
