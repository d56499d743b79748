// `ensemble report`: what tagging saves, of a wardrobe or of what a scene's people wear.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "assetpipe/report.h"
#include "cli/command.h"
#include "cli/report_page.h"
#include "cli/scene_run.h"
#include "core/atomic_file.h"
#include "core/garment_split.h"
#include "core/input_error.h"

namespace ensemble::cli {
namespace {

struct ReportArguments {
  CommonOptions common;
  std::string wardrobe, csv_file, html_file;
  std::vector<std::string> overrides;
  std::uint64_t extrapolate = 0;
};

/// The last part of a path, also where that ends with a slash or is `.`.
std::string folderName(const std::filesystem::path& folder) {
  return std::filesystem::weakly_canonical(folder).filename().string();
}

nlohmann::ordered_json toJson(const LayerFigures& layers) {
  return {{"pairs", layers.pairs},
          {"garment_faces", layers.garment_faces},
          {"hidden_garment_faces", layers.hidden_faces},
          {"drawn_garment_faces", layers.drawn_faces},
          {"garment_lists", layers.lists}};
}

std::string toText(const LayerFigures& layers) {
  if (layers.pairs == 0) return "";
  const double faces = static_cast<double>(std::max<std::uint64_t>(layers.garment_faces, 1));
  return fmt::format(
      "{} {} worn over one another; of the garments' faces {:.1f} % are hidden so, and {:.1f} % are not "
      "drawn, in {} lists\n",
      layers.pairs, layers.pairs == 1 ? "pair of items is" : "pairs of items are",
      100.0 * static_cast<double>(layers.hidden_faces) / faces,
      100.0 * static_cast<double>(layers.garment_faces - layers.drawn_faces) / faces, layers.lists);
}

void runScene(const ReportArguments& arguments) {
  const Scene scene = loadSceneOf({.scene = arguments.wardrobe, .overrides = arguments.overrides});
  std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  const std::vector<WornCombinations> worn = wornIn(scene, wardrobes);
  findLayersOf(worn, wardrobes);
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  CombinationStorage total;
  LayerFigures layers;
  std::uint64_t people = 0, combinations = 0;
  for (std::size_t w = 0; w < wardrobes.size(); ++w) {
    const CombinationStorage stored = storeCombinations(wardrobes[w], worn[w].combinations);
    const LayerFigures layers_here = countLayers(wardrobes[w], worn[w].combinations);
    total += stored;
    layers += layers_here;
    people += worn[w].people;
    combinations += worn[w].combinations.size();
    parts.push_back({{"key", scene.wardrobes[w].key},
                     {"folder", scene.wardrobes[w].folder.string()},
                     {"people", worn[w].people},
                     {"combinations", worn[w].combinations.size()},
                     {"stored", toJson(stored)},
                     {"layers", toJson(layers_here)}});
  }
  const nlohmann::ordered_json figures = {{"schema", "ensemble.scene_report/1"},
                                          {"scene", arguments.wardrobe},
                                          {"people", people},
                                          {"combinations", combinations},
                                          {"wardrobes", std::move(parts)},
                                          {"stored", toJson(total)},
                                          {"layers", toJson(layers)}};
  writeFigures(arguments.common, figures);
  if (!arguments.html_file.empty()) {
    const std::string page = sceneReportPage(figuresAsWritten(figures));
    writeFileAtomically(arguments.html_file, std::string_view(page));
  }
  printResult(arguments.common, fmt::format("{} people in {} combinations\n", people, combinations) +
                                    toTable(total) + toText(layers));
}

/// Options that mean nothing for a scene, or only for one.
void checkOptions(const ReportArguments& arguments, bool is_scene) {
  const auto refuse = [](const char* option, const char* what, const char* mend) {
    throw UsageError({"", option, what, mend});
  };
  constexpr const char* kWardrobeOnly = "a scene is reported as text, JSON and a web page only";
  constexpr const char* kGiveWardrobe = "give the folder of a wardrobe, or leave the option out";
  if (is_scene && !arguments.csv_file.empty()) refuse("--csv", kWardrobeOnly, kGiveWardrobe);
  if (is_scene && arguments.extrapolate > 0) refuse("--extrapolate", kWardrobeOnly, kGiveWardrobe);
  if (!is_scene && !arguments.overrides.empty()) {
    refuse("--set", "a wardrobe has no keys to set", "give a scene, or leave the option out");
  }
}

void run(const ReportArguments& arguments) {
  const std::string ending = std::filesystem::path(arguments.wardrobe).extension().string();
  const bool is_scene =
      (ending == ".yaml" || ending == ".yml") && !std::filesystem::is_directory(arguments.wardrobe);
  checkOptions(arguments, is_scene);
  if (is_scene) {
    runScene(arguments);
    return;
  }
  const Wardrobe wardrobe = loadWardrobe(arguments.wardrobe);
  const Report report = makeReport(wardrobe, arguments.extrapolate);
  nlohmann::ordered_json figures = toJson(report);
  figures["wardrobe"] = folderName(arguments.wardrobe);
  writeFigures(arguments.common, figures);
  if (!arguments.csv_file.empty()) writeFileAtomically(arguments.csv_file, std::string_view(toCsv(report)));
  if (!arguments.html_file.empty()) {
    const std::string page = reportPage(figuresAsWritten(figures));
    writeFileAtomically(arguments.html_file, std::string_view(page));
  }
  printResult(arguments.common, toTable(report));
}

}  // namespace

void addReportCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("report", "Compare the storage of naive, pre-fitted and tagged outfits");
  const auto arguments = std::make_shared<ReportArguments>();
  command
      .add_option(
          "WARDROBE", arguments->wardrobe,
          "The wardrobe's folder; or a scene (.yaml): what the combinations that its people wear store")
      ->required()
      ->type_name("FOLDER|SCENE");
  command
      .add_option("--set", arguments->overrides,
                  "Override a key of the scene, e.g. crowd.count=200; may be given several times")
      ->type_name("KEY.PATH=VALUE")
      ->allow_extra_args(false);
  command.add_option("--csv", arguments->csv_file, "Write the figures as one CSV table (default: none)")
      ->type_name("FILE");
  command
      .add_option("--html", arguments->html_file,
                  "Write a page with plots and tables of the figures: one file, no scripts (default: none)")
      ->type_name("FILE");
  command
      .add_option("--extrapolate", arguments->extrapolate,
                  "Also count the faces of 1 to N outfits, extrapolated from the mean outfit as in figure 6 "
                  "of Lister, "
                  "Laycock and Day; 1 to 1000000 (default: none)")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  finishCommand(command, arguments->common,
                "ensemble report wardrobes/women --extrapolate 20 --html report.html",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
