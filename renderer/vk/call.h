// Every Vulkan result is tested; a failure tells the call, the result and where it was made.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "renderer/vk/vulkan.h"

namespace ensemble::gpu {

/// A failed Vulkan call: `CALL: RESULT (FILE:LINE)`. Turned into a SystemError at the renderer's face.
class VulkanError : public std::runtime_error {
 public:
  VulkanError(vk::Result result, const std::string& line) : std::runtime_error(line), result_(result) {}
  vk::Result result() const noexcept { return result_; }

 private:
  vk::Result result_;
};

/// Throws the VulkanError of a call.
[[noreturn]] void throwVulkanError(vk::Result result, const char* call, const char* file, int line);

/// Runs `function`; a vk::SystemError leaves as a VulkanError with the place of the call.
template <class Function>
decltype(auto) located(Function&& function, const char* call, const char* file, int line) {
  try {
    return std::forward<Function>(function)();
  } catch (const vk::SystemError& error) {
    throwVulkanError(static_cast<vk::Result>(error.code().value()), call, file, line);
  }
}

}  // namespace ensemble::gpu

/// ENSEMBLE_VK(expression): its value, or a VulkanError that names it and this line.
#define ENSEMBLE_VK(...) \
  ::ensemble::gpu::located([&]() -> decltype(auto) { return __VA_ARGS__; }, #__VA_ARGS__, __FILE__, __LINE__)
