// `ensemble author`: outfits from recipes.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "assetpipe/author_outfit.h"
#include "assetpipe/segment.h"
#include "cli/command.h"
#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "core/input_error.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble::cli {
namespace {

struct AuthorArguments {
  CommonOptions common;
  std::vector<std::string> recipes;
  std::string template_file, folder;
};

nlohmann::ordered_json figuresOf(const Recipe& recipe, const std::string& file,
                                 const AuthoredOutfit& outfit) {
  const auto millimetres = [](float metres) { return std::round(static_cast<double>(metres) * 1e5) / 100.0; };
  nlohmann::ordered_json figures = {{"name", recipe.name},
                                    {"file", file},
                                    {"slot", toString(recipe.slot)},
                                    {"layer", recipe.layer},
                                    {"garments", nlohmann::ordered_json::array()}};
  for (const GarmentFigures& garment : outfit.garments) {
    figures["garments"].push_back({{"name", garment.name},
                                   {"faces", garment.faces},
                                   {"vertices", garment.vertices},
                                   {"distance_mm",
                                    {{"min", millimetres(garment.least_distance)},
                                     {"mean", millimetres(garment.mean_distance)},
                                     {"max", millimetres(garment.greatest_distance)}}},
                                   {"vertices_in_body", garment.pokes.cloth_in_body},
                                   {"body_vertices_in_front", garment.pokes.body_in_front}});
  }
  return figures;
}

/// All recipes are read before the first is made: a mistake in the last one costs no time.
std::vector<Recipe> loadRecipes(const AuthorArguments& arguments) {
  std::vector<Recipe> recipes;
  for (const std::string& file : arguments.recipes) {
    recipes.push_back(loadRecipe(file));
    for (std::size_t i = 0; i + 1 < recipes.size(); ++i) {
      if (recipes[i].name != recipes.back().name) continue;
      throw InputError(
          {file, "",
           "its outfit is named '" + recipes.back().name + "', as that of " + recipes[i].file.string(),
           "give each recipe a name of its own"});
    }
  }
  return recipes;
}

void makeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw SystemError(
      {folder, "", "the folder can't be made: " + error.message(), "choose a place that you may write to"});
}

void run(const AuthorArguments& arguments) {
  const std::vector<Recipe> recipes = loadRecipes(arguments);
  const RawAsset asset = readGltf(arguments.template_file);
  std::vector<std::string> warnings;
  const TemplateBody body = segmentTemplate(asset, {}, arguments.template_file, warnings);
  const AuthorBody measured(body);
  nlohmann::ordered_json figures = {{"schema", "ensemble.author/1"},
                                    {"template", arguments.template_file},
                                    {"outfits", nlohmann::ordered_json::array()}};
  std::string text;
  Progress progress("author", recipes.size());
  for (const Recipe& recipe : recipes) {
    const AuthoredOutfit outfit = authorOutfit(recipe, asset, measured);
    makeFolder(arguments.folder);
    const std::filesystem::path file = std::filesystem::path(arguments.folder) / (recipe.name + ".glb");
    writeFileAtomically(file, writeGlb(outfit.asset));
    logDetail("wrote " + file.string());
    for (const std::string& warning : outfit.warnings) logWarning(warning);
    figures["outfits"].push_back(figuresOf(recipe, file.string(), outfit));
    std::size_t faces = 0;
    for (const GarmentFigures& garment : outfit.garments) faces += garment.faces;
    text += fmt::format("{}: {} garments, {} faces, slot {}, layer {}\n", file.string(),
                        outfit.garments.size(), faces, toString(recipe.slot), recipe.layer);
    progress.advance();
  }
  writeFigures(arguments.common, figures);
  printResult(arguments.common, text);
}

}  // namespace

void addAuthorCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand("author", "Make outfits for a template from recipes");
  const auto arguments = std::make_shared<AuthorArguments>();
  command.add_option("RECIPE", arguments->recipes, "What to make (docs/authoring.md); one outfit each")
      ->required()
      ->type_name("FILE.yaml");
  command
      .add_option("--template", arguments->template_file,
                  "Whom to dress: a GLB with regions as materials and joints of the usual names")
      ->required()
      ->type_name("FILE.glb");
  command.add_option("-o,--output", arguments->folder, "Write NAME.glb of each recipe here")
      ->required()
      ->type_name("FOLDER");
  finishCommand(command, arguments->common,
                "ensemble author outfits/*.yaml --template people/woman/template.glb -o wardrobe/items",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
