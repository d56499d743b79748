// What `render` and `bench` share: a scene with overrides, its wardrobes, the validation layer.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/command.h"
#include "core/environment_mesh.h"
#include "core/scene.h"
#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"
#include "renderer/renderer.h"

namespace ensemble::cli {

/// The options that name a scene.
struct SceneArguments {
  std::string scene;
  std::vector<std::string> overrides;  ///< key.path=value
  bool validate = false;
};
void addSceneOptions(CLI::App& command, SceneArguments& arguments);

/// @throws InputError, UsageError as loadScene
Scene loadSceneOf(const SceneArguments& arguments);

/// The wardrobes of a scene, in its order. @throws as loadWardrobe
std::vector<Wardrobe> loadWardrobes(const Scene& scene);

/// What one wardrobe's people wear.
struct WornCombinations {
  std::vector<Combination> combinations;
  std::uint64_t people = 0;
};
/// Per wardrobe. @throws as populateCrowd
std::vector<WornCombinations> wornIn(const Scene& scene, std::span<const Wardrobe> wardrobes);

/// Finds what the items that a scene's people wear hide of one another (assetpipe/find_layers.h).
/// @throws as populateCrowd and findLayers
void findLayersOf(const Scene& scene, std::span<Wardrobe> wardrobes);
/// The same of what they are known to wear. @param worn as wornIn returns it @throws as findLayers
void findLayersOf(std::span<const WornCombinations> worn, std::span<Wardrobe> wardrobes);

/// The environment of a scene, if it has one; logs what of it is not used.
/// @throws as loadEnvironmentMesh
std::optional<EnvironmentMesh> loadEnvironment(const Scene& scene);

/// Logs what validation layers have said. @throws SystemError if there is anything
void refuseValidationMessages(const std::vector<std::string>& messages);
void refuseValidationMessages(const Renderer& renderer);

}  // namespace ensemble::cli
