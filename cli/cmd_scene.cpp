// `ensemble scene`: the reference scene, to begin one's own with.
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "core/atomic_file.h"
#include "core/scene.h"

namespace ensemble::cli {
namespace {

struct SceneFileArguments {
  CommonOptions common;
  std::string output;
};

void run(const SceneFileArguments& arguments) {
  const std::string text = referenceScene();
  if (arguments.output.empty()) {
    printResult(arguments.common, text);
  } else {
    writeFileAtomically(arguments.output, std::string_view(text));
  }
  writeFigures(arguments.common, {{"schema", "ensemble.scene/1"}, {"text", text}});
}

}  // namespace

void addSceneCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("scene", "Write a scene file with every key explained");
  const auto arguments = std::make_shared<SceneFileArguments>();
  command.add_option("-o,--output", arguments->output, "Where it goes; default: standard output")
      ->type_name("FILE");
  finishCommand(command, arguments->common, "ensemble scene -o scene.yaml", [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
