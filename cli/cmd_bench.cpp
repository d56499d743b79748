// `ensemble bench`: techniques and rasterisers side by side, in interleaved rounds.
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
#include "cli/frame_list.h"
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
  std::string techniques = "naive,prefitted,tagged", rasterisers, counts, frames, csv_file, html_file;
  std::optional<std::uint32_t> rounds, warm_up;
};

constexpr std::uint32_t kRounds = 15, kMostRounds = 10000;

std::vector<std::string_view> splitList(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// Names parted by commas, each once; `parse` gives none for what it does not know.
template <class Kind>
std::vector<Kind> parseKinds(const std::string& text, std::optional<Kind> (*parse)(std::string_view),
                             const char* option, const char* what, const char* known) {
  std::vector<Kind> kinds;
  for (const std::string_view name : splitList(text)) {
    const std::optional<Kind> kind = parse(name);
    if (!kind) {
      throw UsageError({.file = {},
                        .where = option,
                        .what = fmt::format("unknown {} '{}'", what, name),
                        .mend = std::string("choose from ") + known});
    }
    if (std::find(kinds.begin(), kinds.end(), *kind) == kinds.end()) kinds.push_back(*kind);
  }
  return kinds;
}

std::vector<Technique> parseTechniques(const std::string& text) {
  return parseKinds(text, parseTechnique, "--techniques", "technique", "naive,prefitted,tagged");
}

/// The scene's own where none are given.
std::vector<RasterKind> parseRasterisers(const std::string& text, const Scene& scene) {
  if (text.empty()) return {scene.raster};
  return parseKinds(text, parseRasterKind, "--rasterisers", "rasteriser", "auto,pipeline,compute");
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
    if (row.invocations_differ_by == 0) continue;
    logWarning(fmt::format(
        "{} by {} with {} people: this device's counts of vertex invocations of a frame differ "
        "by up to {} between rounds",
        toString(row.technique), toString(row.raster), row.characters, row.invocations_differ_by));
  }
}

/// What is drawn, and how often.
struct Plan {
  ContestOptions contest;
  std::uint32_t warm_up = 1, rounds = kRounds;
};

Plan planOf(const BenchArguments& arguments, const Scene& scene) {
  Plan plan{.contest = {.techniques = parseTechniques(arguments.techniques),
                        .rasters = parseRasterisers(arguments.rasterisers, scene),
                        .frames = {0},
                        .validate = arguments.scene.validate}};
  if (!arguments.frames.empty()) plan.contest.frames = parseFrames(arguments.frames, scene.output.frames);
  if (plan.contest.frames.size() > kMostRounds) {
    throw UsageError({.file = {},
                      .where = "--frames",
                      .what = fmt::format("{} frames are more than the {} that bench draws",
                                          plan.contest.frames.size(), kMostRounds),
                      .mend = "list fewer"});
  }
  const auto frame_count = static_cast<std::uint32_t>(plan.contest.frames.size());
  plan.warm_up = arguments.warm_up.value_or(frame_count);
  plan.rounds = arguments.rounds.value_or(std::max(kRounds, frame_count));
  return plan;
}

Json figuresOf(const BenchArguments& arguments, const Scene& scene, const Plan& plan) {
  return {{"schema", "ensemble.bench/1"},    {"device", ""},
          {"width", scene.output.width},     {"height", scene.output.height},
          {"samples", scene.output.samples}, {"scene", fs::path(arguments.scene.scene).filename().string()},
          {"frames", plan.contest.frames},   {"fps", scene.output.fps},
          {"rounds", plan.rounds},           {"warm_up_rounds", plan.warm_up},
          {"rows", Json::array()},           {"ratios", Json::array()},
          {"picture_errors", Json::array()}};
}

void run(const BenchArguments& arguments) {
  const Scene scene = loadSceneOf(arguments.scene);
  const Plan plan = planOf(arguments, scene);
  const std::vector<std::string> counts = parseCounts(arguments.counts, scene);
  std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  const std::optional<EnvironmentMesh> environment = loadEnvironment(scene);
  Json figures = figuresOf(arguments, scene, plan);
  Progress progress("rounds", (std::uint64_t{plan.warm_up} + plan.rounds) * counts.size());
  for (const std::string& count : counts) {
    SceneArguments with_count = arguments.scene;
    with_count.overrides.push_back("crowd.count=" + count);
    const Scene contested = loadSceneOf(with_count);
    findLayersOf(contested, wardrobes);
    Contest contest(contested, wardrobes, environment ? &*environment : nullptr, plan.contest);
    for (std::uint32_t round = 0; round < plan.warm_up + plan.rounds; ++round) {
      round < plan.warm_up ? contest.runWarmUpRound() : contest.runRound();
      progress.advance();
    }
    figures["device"] = contest.deviceName();
    addContest(contest.rows(), contest.errors(), figures);
    tellOfDifferentInvocations(contest.rows());
    contest.refuseMessages();
  }
  writeFiles(arguments, figures);
  printResult(arguments.common, benchTable(figures));
}

}  // namespace

void addBenchCommand(CLI::App& app) {
  CLI::App& command = *app.add_subcommand(
      "bench", "Compare the techniques' and rasterisers' frame time, vertex work and memory");
  const auto arguments = std::make_shared<BenchArguments>();
  const auto option = [&](const char* name, auto& value, const char* type, const char* text) {
    return command.add_option(name, value, text)->type_name(type);
  };
  addSceneOptions(command, arguments->scene);
  option("--techniques", arguments->techniques, "LIST",
         "Which to compare, parted by commas: naive, prefitted, tagged (default: all)");
  option("--rasterisers", arguments->rasterisers, "LIST",
         "Each technique is drawn by each of these, parted by commas: auto, pipeline, compute (default: the "
         "scene's "
         "raster alone)");
  option("--counts", arguments->counts, "LIST",
         "Numbers of people in the crowd, parted by commas, each 1 or more; the scene's named people come on "
         "top "
         "(default: the scene's crowd.count)");
  option(
      "--frames", arguments->frames, "A-B,C",
      "Which frames of the scene to draw, e.g. 0-29: one a round, over and over, at its time i/fps, so that "
      "people walk and the camera goes along its keys or orbit (default: frame 0 alone)");
  option("--rounds", arguments->rounds, "N",
         "Counted frames of each row for each number of people, 1 to 10000 (default: 15, or once through "
         "--frames where these are more)")
      ->check(CLI::Range(1u, kMostRounds));
  option("--warm-up", arguments->warm_up, "N",
         "Rounds before these that are not counted, 1 to 10000 (default: once through --frames)")
      ->check(CLI::Range(1u, kMostRounds));
  option("--csv", arguments->csv_file, "FILE", "Write the rows as a CSV table (default: none)");
  option("--html", arguments->html_file, "FILE",
         "Write a page with plots and tables of the figures: one file, no scripts (default: none)");
  finishCommand(command, arguments->common,
                "ensemble bench scene.yaml --counts 100,300,1000 --html bench.html",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
