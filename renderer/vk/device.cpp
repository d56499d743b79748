#include "renderer/vk/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

#include "core/input_error.h"

namespace ensemble::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint32_t kVulkanVersion = VK_API_VERSION_1_3;

VKAPI_ATTR VkBool32 VKAPI_CALL onValidationMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                   VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                   void* log) {
  static_cast<ValidationLog*>(log)->add(data->pMessage);
  return VK_FALSE;
}

bool hasValidationLayer(const vk::raii::Context& context) {
  const auto layers = context.enumerateInstanceLayerProperties();
  return std::any_of(layers.begin(), layers.end(), [](const vk::LayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

bool countsTime(const vk::raii::PhysicalDevice& device, std::uint32_t family) {
  return device.getQueueFamilyProperties()[family].timestampValidBits == 64;
}

std::optional<std::uint32_t> graphicsQueueFamily(const vk::raii::PhysicalDevice& device) {
  constexpr auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  const auto families = device.getQueueFamilyProperties();
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & wanted) == wanted) return i;
  }
  return std::nullopt;
}

/// What a device lacks for this renderer; empty if nothing.
std::string missingFrom(const vk::raii::PhysicalDevice& device) {
  if (device.getProperties().apiVersion < kVulkanVersion) return "Vulkan 1.3";
  if (!graphicsQueueFamily(device)) return "a queue for graphics and compute";
  const auto chain = device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan11Features,
                                         vk::PhysicalDeviceVulkan13Features>();
  const auto& core = chain.get<vk::PhysicalDeviceFeatures2>().features;
  const auto& v11 = chain.get<vk::PhysicalDeviceVulkan11Features>();
  const auto& v13 = chain.get<vk::PhysicalDeviceVulkan13Features>();
  if (!core.multiDrawIndirect) return "multiDrawIndirect";
  if (!core.drawIndirectFirstInstance) return "drawIndirectFirstInstance";
  if (!core.geometryShader) return "geometryShader (for gl_PrimitiveID)";
  if (!core.depthClamp) return "depthClamp";
  if (!v11.shaderDrawParameters) return "shaderDrawParameters";
  if (!v13.dynamicRendering) return "dynamicRendering";
  if (!v13.synchronization2) return "synchronization2";
  if (!v13.maintenance4) return "maintenance4";
  return {};
}

/// What our rasteriser asks for beyond what every device must have.
bool canRasteriseOn(const vk::raii::PhysicalDevice& device) {
  constexpr std::uint32_t kTexels = 1u << 26;  // 16-bit indices in a buffer of 128 MiB
  const auto features =
      device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
  const auto properties =
      device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>();
  const auto& subgroup = properties.get<vk::PhysicalDeviceSubgroupProperties>();
  constexpr auto wanted = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eShuffle;
  return features.get<vk::PhysicalDeviceFeatures2>().features.shaderInt64 &&
         features.get<vk::PhysicalDeviceVulkan12Features>().shaderBufferInt64Atomics &&
         (subgroup.supportedOperations & wanted) == wanted &&
         (subgroup.supportedStages & vk::ShaderStageFlagBits::eCompute) &&
         properties.get<vk::PhysicalDeviceProperties2>().properties.limits.maxTexelBufferElements >= kTexels;
}

int rank(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 0;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 1;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 2;
    case vk::PhysicalDeviceType::eOther:
      return 3;
    default:
      return 4;
  }
}

vk::raii::Instance makeInstance(const vk::raii::Context& context, bool validate) {
  const vk::ApplicationInfo application{
      .pApplicationName = "ensemble", .pEngineName = "ensemble", .apiVersion = kVulkanVersion};
  constexpr std::array enabled = {vk::ValidationFeatureEnableEXT::eSynchronizationValidation};
  const vk::ValidationFeaturesEXT features{.enabledValidationFeatureCount = enabled.size(),
                                           .pEnabledValidationFeatures = enabled.data()};
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  return ENSEMBLE_VK(
      vk::raii::Instance(context, vk::InstanceCreateInfo{.pNext = validate ? &features : nullptr,
                                                         .pApplicationInfo = &application,
                                                         .enabledLayerCount = validate ? 1u : 0u,
                                                         .ppEnabledLayerNames = &kValidationLayer,
                                                         .enabledExtensionCount = validate ? 1u : 0u,
                                                         .ppEnabledExtensionNames = &extension}));
}

/// The device to use, and in `lacks` why others were passed over.
std::optional<vk::raii::PhysicalDevice> bestDevice(const vk::raii::Instance& instance, std::string& lacks) {
  vk::raii::PhysicalDevices devices(instance);
  std::stable_sort(devices.begin(), devices.end(), [](const auto& a, const auto& b) {
    return rank(a.getProperties().deviceType) < rank(b.getProperties().deviceType);
  });
  for (vk::raii::PhysicalDevice& device : devices) {
    const std::string missing = missingFrom(device);
    if (missing.empty()) return std::move(device);
    lacks += fmt::format("{}{} lacks {}", lacks.empty() ? "" : ", ", device.getProperties().deviceName.data(),
                         missing);
  }
  return std::nullopt;
}

[[noreturn]] void throwNoDevice(const std::string& why) {
  throw SystemError({.file = {},
                     .where = "Vulkan",
                     .what = why,
                     .mend = "install a Vulkan 1.3 driver, e.g. apt install mesa-vulkan-drivers"});
}

}  // namespace

void throwVulkanError(vk::Result result, const char* call, const char* file, int line) {
  const std::string_view name = std::string_view(call).substr(0, std::string_view(call).find('('));
  throw VulkanError(result, fmt::format("{}: {} ({}:{})", name, vk::to_string(result), file, line));
}

std::string describeBytes(std::uint64_t bytes) {
  if (bytes >= 1ull << 30) return fmt::format("{:.2f} GiB", static_cast<double>(bytes) / (1ull << 30));
  if (bytes >= 1ull << 20) return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1ull << 20));
  return fmt::format("{} bytes", bytes);
}

void ValidationLog::add(const char* message) {
  const std::lock_guard lock(mutex_);
  messages_.emplace_back(message);
}

std::vector<std::string> ValidationLog::messages() const {
  const std::lock_guard lock(mutex_);
  return messages_;
}

Device::Device(const DeviceOptions& options)
    : options_(options), memory_in_use_(options.memory ? options.memory : std::make_shared<MemoryBudget>()) {
  createInstance();
  choosePhysicalDevice();
  createDevice();
}

Device::~Device() {
  try {
    if (*device_) device_.waitIdle();
  } catch (const vk::SystemError&) {  // A lost device; there is nothing left to wait for.
  }
  memory_in_use_->giveBack(allocated_);  // what an error kept from being given back
}

void Device::createInstance() {
  if (options_.validate && !hasValidationLayer(context_)) {
    throw SystemError({.file = {},
                       .where = "Vulkan",
                       .what = "the validation layer is not installed",
                       .mend = "apt install vulkan-validationlayers, or leave out --validate"});
  }
  try {
    instance_ = makeInstance(context_, options_.validate);
  } catch (const VulkanError& error) {
    throwNoDevice(error.result() == vk::Result::eErrorIncompatibleDriver ? "there is no Vulkan driver"
                                                                         : error.what());
  }
  if (!options_.validate) return;
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  messenger_ = ENSEMBLE_VK(vk::raii::DebugUtilsMessengerEXT(
      instance_, vk::DebugUtilsMessengerCreateInfoEXT{
                     .messageSeverity = Severity::eWarning | Severity::eError,
                     .messageType = Type::eGeneral | Type::eValidation | Type::ePerformance,
                     .pfnUserCallback = onValidationMessage,
                     .pUserData = &log_}));
}

void Device::choosePhysicalDevice() {
  std::string lacks;
  std::optional<vk::raii::PhysicalDevice> best;
  try {
    best = bestDevice(instance_, lacks);
  } catch (const vk::SystemError& error) {
    throwNoDevice(error.what());
  }
  if (!best) throwNoDevice(lacks.empty() ? "there is no Vulkan device" : "no device will do: " + lacks);
  physical_ = std::move(*best);
  properties_ = physical_.getProperties();
  memory_ = physical_.getMemoryProperties();
  queue_family_ = *graphicsQueueFamily(physical_);
  has_timestamps_ = countsTime(physical_, queue_family_);
  can_rasterise_ = canRasteriseOn(physical_);
  can_count_draws_ = physical_.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>()
                         .get<vk::PhysicalDeviceVulkan12Features>()
                         .drawIndirectCount;
  subgroup_size_ =
      physical_.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>()
          .get<vk::PhysicalDeviceSubgroupProperties>()
          .subgroupSize;
}

void Device::createDevice() {
  const vk::PhysicalDeviceFeatures offered = physical_.getFeatures();
  features_ = vk::PhysicalDeviceFeatures{.geometryShader = true,
                                         .multiDrawIndirect = true,
                                         .drawIndirectFirstInstance = true,
                                         .depthClamp = true,
                                         .samplerAnisotropy = offered.samplerAnisotropy,
                                         .occlusionQueryPrecise = offered.occlusionQueryPrecise,
                                         .pipelineStatisticsQuery = offered.pipelineStatisticsQuery,
                                         .shaderInt64 = can_rasterise_};
  vk::PhysicalDeviceVulkan13Features v13{
      .synchronization2 = true, .dynamicRendering = true, .maintenance4 = true};
  vk::PhysicalDeviceVulkan12Features v12{
      .pNext = &v13, .drawIndirectCount = can_count_draws_, .shaderBufferInt64Atomics = can_rasterise_};
  vk::PhysicalDeviceVulkan11Features v11{.pNext = &v12, .shaderDrawParameters = true};
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue_info{
      .queueFamilyIndex = queue_family_, .queueCount = 1, .pQueuePriorities = &priority};
  device_ = ENSEMBLE_VK(vk::raii::Device(physical_, vk::DeviceCreateInfo{.pNext = &v11,
                                                                         .queueCreateInfoCount = 1,
                                                                         .pQueueCreateInfos = &queue_info,
                                                                         .pEnabledFeatures = &features_}));
  queue_ = device_.getQueue(queue_family_, 0);
  pool_ = ENSEMBLE_VK(vk::raii::CommandPool(
      device_, vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eTransient,
                                         .queueFamilyIndex = queue_family_}));
}

std::uint64_t Device::memoryLimit() const {
  std::uint64_t total = 0;
  for (std::uint32_t i = 0; i < memory_.memoryHeapCount; ++i) {
    const vk::MemoryHeap& heap = memory_.memoryHeaps[i];
    if (heap.flags & vk::MemoryHeapFlagBits::eDeviceLocal) total = std::max(total, std::uint64_t{heap.size});
  }
  return options_.memory_limit != 0 ? std::min(total, options_.memory_limit) : total;
}

vk::raii::DeviceMemory Device::allocate(const vk::MemoryRequirements& wanted,
                                        vk::MemoryPropertyFlags required, vk::MemoryPropertyFlags preferred,
                                        const std::string& what) {
  const auto refuse = [&] {
    const std::uint64_t used = memoryInUse(), most = memoryLimit();
    throw SystemError({.file = {},
                       .where = "Vulkan device " + name(),
                       .what = fmt::format("{} of {} does not fit: {} are in use and {} are left", what,
                                           describeBytes(wanted.size), describeBytes(used),
                                           describeBytes(most > used ? most - used : 0)),
                       .mend = "use fewer people, smaller pictures or smaller textures"});
  };
  std::optional<std::uint32_t> type;
  for (const vk::MemoryPropertyFlags flags : {required | preferred, required}) {
    for (std::uint32_t i = 0; i < memory_.memoryTypeCount && !type; ++i) {
      const bool fits = (memory_.memoryTypes[i].propertyFlags & flags) == flags;
      if (fits && (wanted.memoryTypeBits & (1u << i))) type = i;
    }
  }
  if (!type) throwNoDevice(fmt::format("{} has no memory for {}", name(), what));
  if (!memory_in_use_->take(wanted.size, memoryLimit())) refuse();
  allocated_ += wanted.size;
  try {
    return ENSEMBLE_VK(vk::raii::DeviceMemory(
        device_, vk::MemoryAllocateInfo{.allocationSize = wanted.size, .memoryTypeIndex = *type}));
  } catch (const VulkanError& error) {
    freed(wanted.size);
    const bool full = error.result() == vk::Result::eErrorOutOfDeviceMemory ||
                      error.result() == vk::Result::eErrorOutOfHostMemory;
    if (full) refuse();
    throw;
  }
}

void Device::freed(std::uint64_t bytes) {
  allocated_ -= bytes;
  memory_in_use_->giveBack(bytes);
}

void Device::runOnce(const std::function<void(const vk::raii::CommandBuffer&)>& record) {
  vk::raii::CommandBuffers buffers = ENSEMBLE_VK(vk::raii::CommandBuffers(
      device_,
      vk::CommandBufferAllocateInfo{
          .commandPool = *pool_, .level = vk::CommandBufferLevel::ePrimary, .commandBufferCount = 1}));
  const vk::raii::CommandBuffer& commands = buffers.front();
  ENSEMBLE_VK(commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit}));
  record(commands);
  ENSEMBLE_VK(commands.end());
  const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *commands};
  ENSEMBLE_VK(
      queue_.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted}));
  ENSEMBLE_VK(queue_.waitIdle());
}

std::string chosenDeviceName() noexcept {
  try {
    const vk::raii::Context context;
    const vk::raii::Instance instance = makeInstance(context, false);
    std::string lacks;
    const auto device = bestDevice(instance, lacks);
    return device ? std::string(device->getProperties().deviceName) : "none";
  } catch (...) {
    return "none";
  }
}

}  // namespace ensemble::gpu
