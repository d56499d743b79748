// A Vulkan device without a window, its one queue, and what the validation layer says.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/memory_budget.h"
#include "renderer/vk/call.h"

namespace ensemble::gpu {

struct DeviceOptions {
  bool validate = false;                      ///< the validation layer with synchronization validation
  std::uint64_t memory_limit = 0;             ///< bytes that may be allocated; 0: what the device has
  std::shared_ptr<MemoryBudget> memory = {};  ///< what counts against it; null: this device's own
};

/// Warnings and errors of the validation layer, in the order they came.
class ValidationLog {
 public:
  void add(const char* message);
  std::vector<std::string> messages() const;

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// Instance, device, queue. Does not move: other objects keep references to it.
class Device {
 public:
  /// The best device that can draw a crowd: discrete, then integrated, then the rest, then CPU.
  /// @throws SystemError if there is none, or the validation layer is asked for and missing.
  explicit Device(const DeviceOptions& options);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  const vk::raii::Device& handle() const { return device_; }
  const vk::raii::Queue& queue() const { return queue_; }
  const vk::PhysicalDeviceLimits& limits() const { return properties_.limits; }
  const vk::PhysicalDeviceFeatures& features() const { return features_; }
  std::uint32_t queueFamily() const { return queue_family_; }
  std::string name() const { return properties_.deviceName; }
  bool isCpu() const { return properties_.deviceType == vk::PhysicalDeviceType::eCpu; }
  bool hasPipelineStatistics() const { return features_.pipelineStatisticsQuery; }
  bool hasTimestamps() const { return has_timestamps_; }
  /// Whether compute shaders have what our rasteriser needs: 64-bit atomics in buffers, shuffles in
  /// subgroups.
  bool canRasterise() const { return can_rasterise_; }
  /// Whether draws may take their number from a buffer.
  bool canCountDraws() const { return can_count_draws_; }
  std::uint32_t subgroupSize() const { return subgroup_size_; }
  std::vector<std::string> validationMessages() const { return log_.messages(); }

  /// Memory for a resource. @param what names it in the error
  /// @throws SystemError with the size wanted and what is left, if it does not fit.
  vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& wanted, vk::MemoryPropertyFlags required,
                                  vk::MemoryPropertyFlags preferred, const std::string& what);
  /// Tells that memory from `allocate` was freed.
  void freed(std::uint64_t bytes);
  /// Of all who share the account.
  std::uint64_t memoryInUse() const { return memory_in_use_->used(); }
  std::uint64_t memoryLimit() const;

  /// Records commands, submits them and waits. For loading, not for frames.
  void runOnce(const std::function<void(const vk::raii::CommandBuffer&)>& record);

 private:
  void createInstance();
  void choosePhysicalDevice();
  void createDevice();

  DeviceOptions options_;
  ValidationLog log_;
  vk::raii::Context context_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  vk::raii::PhysicalDevice physical_ = nullptr;
  vk::PhysicalDeviceProperties properties_;
  vk::PhysicalDeviceFeatures features_;
  vk::PhysicalDeviceMemoryProperties memory_;
  std::uint32_t queue_family_ = 0;
  bool has_timestamps_ = false;
  bool can_rasterise_ = false;
  bool can_count_draws_ = false;
  std::uint32_t subgroup_size_ = 1;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::CommandPool pool_ = nullptr;
  std::shared_ptr<MemoryBudget> memory_in_use_;
  std::uint64_t allocated_ = 0;  // of these bytes, this device's
};

/// The name of the device that `Device` would choose, or "none". Never throws.
std::string chosenDeviceName() noexcept;

/// "1.5 GiB", "640.0 MiB", "12 bytes".
std::string describeBytes(std::uint64_t bytes);

}  // namespace ensemble::gpu
