// What `render` and `bench` share: a scene with overrides, its wardrobes, the validation layer.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "core/environment_mesh.h"
#include "core/scene.h"
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

/// The environment of a scene, if it has one; logs what of it is not used.
/// @throws as loadEnvironmentMesh
std::optional<EnvironmentMesh> loadEnvironment(const Scene& scene);

/// Logs what the validation layer has said. @throws SystemError if there is anything
void refuseValidationMessages(const Renderer& renderer);

}  // namespace ensemble::cli
