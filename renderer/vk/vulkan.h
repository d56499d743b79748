// Vulkan-Hpp as this project uses it: RAII handles, exceptions, designated initialisers.
// The renderer target precompiles it.
#pragma once

#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VULKAN_HPP_NO_STRUCT_SETTERS
#define VULKAN_HPP_NO_SPACESHIP_OPERATOR
#include <vulkan/vulkan_raii.hpp>
