// `ensemble people`: template people made from a few parameters, and dressed.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "assetpipe/make_people.h"
#include "cli/command.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble::cli {
namespace {

struct PeopleArguments {
  CommonOptions common;
  std::string config, folder;
  unsigned jobs = 0;
};

std::size_t faceCount(const RawMeshNode& node) {
  std::size_t faces = 0;
  for (const RawPrimitive& primitive : node.primitives) faces += primitive.faces.size();
  return faces;
}

nlohmann::ordered_json figuresOf(const MadePerson& person) {
  nlohmann::ordered_json figures = {{"name", person.name},
                                    {"body_faces", faceCount(person.body.meshes.front())},
                                    {"joints", person.body.skeleton.joints.size()},
                                    {"walk_speed", person.walk_speed},
                                    {"run_speed", person.run_speed},
                                    {"outfits", nlohmann::ordered_json::array()}};
  for (const MadeOutfit& made : person.outfits) {
    nlohmann::ordered_json entry = {{"name", made.recipe.name},
                                    {"slot", toString(made.recipe.slot)},
                                    {"layer", made.recipe.layer},
                                    {"garments", nlohmann::ordered_json::array()}};
    for (const GarmentFigures& garment : made.outfit.garments)
      entry["garments"].push_back({{"name", "garment." + garment.name}, {"faces", garment.faces}});
    figures["outfits"].push_back(std::move(entry));
  }
  return figures;
}

void run(const PeopleArguments& arguments) {
  const PeopleConfig config = loadPeopleConfig(arguments.config);
  nlohmann::ordered_json figures = {{"schema", "ensemble.people/1"},
                                    {"people", nlohmann::ordered_json::array()}};
  std::string text;
  Progress progress("people", config.people.size());
  for (const PersonConfig& person_config : config.people) {
    const MadePerson person = makePerson(person_config, arguments.jobs);
    for (const auto& file : writePerson(person, arguments.folder)) logDetail("wrote " + file.string());
    for (const MadeOutfit& made : person.outfits)
      for (const std::string& warning : made.outfit.warnings) logWarning(person.name + ": " + warning);
    figures["people"].push_back(figuresOf(person));
    text +=
        fmt::format("{}: {} faces, {} outfits in {}\n", person.name, faceCount(person.body.meshes.front()),
                    person.outfits.size(), (std::filesystem::path(arguments.folder) / person.name).string());
    progress.advance();
  }
  writeFigures(arguments.common, figures);
  printResult(arguments.common, text);
}

}  // namespace

void addPeopleCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("people", "Make template people from a few parameters, and dress them");
  const auto arguments = std::make_shared<PeopleArguments>();
  command
      .add_option("CONFIG", arguments->config,
                  "Who to make: names, sex, age, height, girth, build, colours, outfits (docs/people.md)")
      ->required()
      ->type_name("FILE.yaml");
  command.add_option("-o,--output", arguments->folder, "Write NAME/template.glb and NAME/outfits/ here")
      ->required()
      ->type_name("FOLDER");
  command.add_option("-j,--jobs", arguments->jobs, "Threads, 1 to 256; default: one a core")
      ->check(CLI::Range(1, 256))
      ->type_name("N");
  finishCommand(command, arguments->common, "ensemble people config/people/two.yaml -o people",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
