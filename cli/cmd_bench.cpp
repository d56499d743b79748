// `ensemble bench`: the three techniques side by side, in interleaved rounds.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/bench_contest.h"
#include "cli/bench_figures.h"
#include "cli/bench_page.h"
#include "cli/command.h"
#include "cli/scene_run.h"
#include "core/atomic_file.h"
#include "core/input_error.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BenchArguments {
  CommonOptions common;
  SceneArguments scene;
  std::string techniques = "naive,prefitted,tagged", counts, csv_file, html_file;
  std::uint32_t rounds = 15;
};

std::vector<std::string_view> splitList(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::vector<Technique> parseTechniques(const std::string& text) {
  std::vector<Technique> techniques;
  for (const std::string_view name : splitList(text)) {
    const std::optional<Technique> technique = parseTechnique(name);
    if (!technique) {
      throw UsageError({.file = {},
                        .where = "--techniques",
                        .what = "unknown technique '" + std::string(name) + "'",
                        .mend = "choose from naive,prefitted,tagged"});
    }
    if (std::find(techniques.begin(), techniques.end(), *technique) == techniques.end())
      techniques.push_back(*technique);
  }
  return techniques;
}

/// Numbers of people in the crowd; what the scene says where none are given.
std::vector<std::string> parseCounts(const std::string& text, const Scene& scene) {
  if (text.empty()) return {std::to_string(scene.crowd.count.value_or(0))};
  std::vector<std::string> counts;
  for (const std::string_view part : splitList(text)) {
    std::uint32_t count = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), count);
    if (error != std::errc() || end != part.data() + part.size() || count == 0) {
      throw UsageError({.file = {},
                        .where = "--counts",
                        .what = "'" + std::string(part) + "' is no number of people",
                        .mend = "write numbers parted by commas, e.g. 100,1000"});
    }
    counts.push_back(std::to_string(count));
  }
  return counts;
}

void writeFiles(const BenchArguments& arguments, const Json& figures) {
  writeFigures(arguments.common, figures);
  if (!arguments.csv_file.empty())
    writeFileAtomically(arguments.csv_file, std::string_view(benchCsv(figures)));
  if (!arguments.html_file.empty()) {
    writeFileAtomically(arguments.html_file, std::string_view(benchPage(figuresAsWritten(figures))));
  }
}

void tellOfDifferentInvocations(std::span<const ContestRow> rows) {
  for (const ContestRow& row : rows) {
    if (row.most_invocations == row.least_invocations) continue;
    logWarning(
        fmt::format("{} with {} people: this device counts from {} to {} vertex invocations in "
                    "different rounds; the figures are those of the warm-up round",
                    toString(row.technique), row.characters, row.least_invocations, row.most_invocations));
  }
}

void run(const BenchArguments& arguments) {
  const std::vector<Technique> techniques = parseTechniques(arguments.techniques);
  const Scene scene = loadSceneOf(arguments.scene);
  std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  const std::optional<EnvironmentMesh> environment = loadEnvironment(scene);
  const std::vector<std::string> counts = parseCounts(arguments.counts, scene);
  Json figures = {
      {"schema", "ensemble.bench/1"},    {"device", ""},
      {"width", scene.output.width},     {"height", scene.output.height},
      {"samples", scene.output.samples}, {"scene", fs::path(arguments.scene.scene).filename().string()},
      {"rounds", arguments.rounds},      {"warm_up_rounds", 1},
      {"rows", Json::array()},           {"ratios", Json::array()}};
  Progress progress("rounds", std::uint64_t{arguments.rounds} * counts.size());
  for (const std::string& count : counts) {
    SceneArguments with_count = arguments.scene;
    with_count.overrides.push_back("crowd.count=" + count);
    const Scene contested = loadSceneOf(with_count);
    findLayersOf(contested, wardrobes);
    Contest contest(contested, wardrobes, environment ? &*environment : nullptr, techniques,
                    arguments.scene.validate);
    for (std::uint32_t round = 0; round < arguments.rounds; ++round) {
      contest.runRound();
      progress.advance();
    }
    figures["device"] = contest.deviceName();
    addContest(contest.rows(), figures);
    tellOfDifferentInvocations(contest.rows());
    contest.refuseMessages();
  }
  writeFiles(arguments, figures);
  printResult(arguments.common, benchTable(figures));
}

}  // namespace

void addBenchCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("bench", "Compare the techniques' frame time, vertex work and memory");
  const auto arguments = std::make_shared<BenchArguments>();
  addSceneOptions(command, arguments->scene);
  command
      .add_option("--techniques", arguments->techniques,
                  "Which to compare, parted by commas: naive, prefitted, tagged (default: all)")
      ->type_name("LIST");
  command
      .add_option("--counts", arguments->counts,
                  "Numbers of people in the crowd, parted by commas, each 1 or more; the scene's named "
                  "people come on "
                  "top (default: the scene's crowd.count)")
      ->type_name("LIST");
  command
      .add_option("--rounds", arguments->rounds,
                  "Counted frames of each technique for each number of people, 1 to 10000 (default 15)")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  command.add_option("--csv", arguments->csv_file, "Write the rows as a CSV table (default: none)")
      ->type_name("FILE");
  command
      .add_option("--html", arguments->html_file,
                  "Write a page with plots and tables of the figures: one file, no scripts (default: none)")
      ->type_name("FILE");
  finishCommand(command, arguments->common,
                "ensemble bench scene.yaml --counts 100,300,1000 --html bench.html",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
