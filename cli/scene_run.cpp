#include "cli/scene_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "assetpipe/find_layers.h"
#include "core/input_error.h"
#include "core/layers.h"
#include "core/log.h"
#include "renderer/crowd.h"

namespace ensemble::cli {

void addSceneOptions(CLI::App& command, SceneArguments& arguments) {
  command.add_option("SCENE", arguments.scene, "The scene's YAML file")->required()->type_name("FILE");
  command
      .add_option("--set", arguments.overrides,
                  "Override a key of the scene, e.g. crowd.count=200; may be given several times")
      ->type_name("KEY.PATH=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--validate", arguments.validate,
                   "Run the Vulkan validation layer and fail on any message (slow; off by default)");
}

Scene loadSceneOf(const SceneArguments& arguments) {
  std::vector<SceneOverride> overrides;
  for (const std::string& text : arguments.overrides) overrides.push_back(parseSceneOverride(text));
  return loadScene(arguments.scene, overrides);
}

std::vector<Wardrobe> loadWardrobes(const Scene& scene) {
  std::vector<Wardrobe> wardrobes;
  for (const SceneWardrobe& wardrobe : scene.wardrobes) wardrobes.push_back(loadWardrobe(wardrobe.folder));
  return wardrobes;
}

std::vector<WornCombinations> wornIn(const Scene& scene, std::span<const Wardrobe> wardrobes) {
  const Crowd crowd = populateCrowd(scene, wardrobes);
  std::vector<WornCombinations> worn(wardrobes.size());
  for (const WornCombination& one : crowd.combinations) worn[one.wardrobe].combinations.push_back(one.items);
  for (const Character& person : crowd.characters) ++worn[person.wardrobe].people;
  return worn;
}

void findLayersOf(const Scene& scene, std::span<Wardrobe> wardrobes) {
  const auto has_pairs = [](const Wardrobe& wardrobe) { return !allLayerPairs(wardrobe).empty(); };
  if (std::none_of(wardrobes.begin(), wardrobes.end(), has_pairs)) return;  // nobody wears one over another
  findLayersOf(wornIn(scene, wardrobes), wardrobes);
}

void findLayersOf(std::span<const WornCombinations> worn, std::span<Wardrobe> wardrobes) {
  for (std::size_t w = 0; w < wardrobes.size(); ++w)
    findLayers(wardrobes[w], layerPairs(wardrobes[w], worn[w].combinations));
}

std::optional<EnvironmentMesh> loadEnvironment(const Scene& scene) {
  if (scene.environment.value.empty()) return std::nullopt;
  EnvironmentMesh mesh = loadEnvironmentMesh(scene);
  if (!mesh.dropped.empty()) {
    logWarning(fmt::format("{}: not used and dropped: {}", mesh.file, fmt::join(mesh.dropped, ", ")));
  }
  for (const std::string& warning : mesh.warnings) logWarning(mesh.file + ": " + warning);
  return mesh;
}

void refuseValidationMessages(const std::vector<std::string>& messages) {
  if (messages.empty()) return;
  for (const std::string& message : messages) logWarning(message);
  throw SystemError({.file = {},
                     .where = "--validate",
                     .what = fmt::format("the validation layer has {} messages", messages.size()),
                     .mend = "report them as a bug"});
}

void refuseValidationMessages(const Renderer& renderer) {
  refuseValidationMessages(renderer.validationMessages());
}

}  // namespace ensemble::cli
