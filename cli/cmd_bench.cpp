// `ensemble bench`: the three techniques side by side, in interleaved rounds.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/command.h"
#include "cli/scene_run.h"
#include "core/input_error.h"
#include "core/progress.h"
#include "renderer/renderer.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

struct BenchArguments {
  CommonOptions common;
  SceneArguments scene;
  std::string techniques = "naive,prefitted,tagged", counts;
  std::uint32_t rounds = 15;
};

/// One technique with one number of people.
struct Row {
  Technique technique = Technique::kTagged;
  std::size_t characters = 0;
  std::vector<double> frame_ms = {}, cpu_ms = {};  ///< per round
  FrameStats stats = {};                           ///< of the last round; the counts are those of every round
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

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

/// All techniques draw the same frame, round by round, so that a slow moment of the machine hits
/// them alike. The first frame of each compiles its shaders and is not counted.
class Contest {
 public:
  Contest(const BenchArguments& arguments, Scene scene, std::span<const Wardrobe> wardrobes,
          const std::vector<Technique>& techniques)
      : view_(viewOf(scene)), pictures_(techniques.size()) {
    for (const Technique technique : techniques) {
      scene.technique = technique;
      renderers_.push_back(std::make_unique<Renderer>(RendererOptions{.validate = arguments.scene.validate}));
      renderers_.back()->load(scene, wardrobes);
      rows_.push_back({.technique = technique, .characters = renderers_.back()->crowd().characters.size()});
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) drawFrame(i);
    checkPictures();
  }

  void runRound() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      drawFrame(i);
      rows_[i].frame_ms.push_back(rows_[i].stats.frame_ms);
      rows_[i].cpu_ms.push_back(rows_[i].stats.cpu_ms);
    }
  }

  const std::vector<Row>& rows() const { return rows_; }
  std::string deviceName() const { return renderers_.front()->deviceName(); }
  void refuseMessages() const {
    for (const auto& renderer : renderers_) refuseValidationMessages(*renderer);
  }

 private:
  void drawFrame(std::size_t i) {
    renderers_[i]->render(std::span(&view_, 1), 0.0, std::span(&pictures_[i], 1));
    rows_[i].stats = pictures_[i].stats;
  }

  /// A figure of a wrong picture is worth nothing.
  void checkPictures() const {
    const auto pictureOf = [&](Technique technique) -> const Picture* {
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (rows_[i].technique == technique) return &pictures_[i];
      }
      return nullptr;
    };
    const Picture* tagged = pictureOf(Technique::kTagged);
    const Picture* prefitted = pictureOf(Technique::kPrefitted);
    if (!tagged || !prefitted || tagged->color.rgba == prefitted->color.rgba) return;
    throw SystemError({.file = {},
                       .where = "bench",
                       .what = "tagged and prefitted give different pictures",
                       .mend = "report it as a bug"});
  }

  View view_;
  std::vector<std::unique_ptr<Renderer>> renderers_;
  std::vector<Picture> pictures_;
  std::vector<Row> rows_;
};

Json toJson(const Row& row) {
  const auto [least, most] = std::minmax_element(row.frame_ms.begin(), row.frame_ms.end());
  const std::optional<std::uint64_t> invocations = row.stats.vertexInvocations();
  return {{"technique", toString(row.technique)},
          {"characters", row.characters},
          {"characters_drawn", row.stats.characters_drawn},
          {"characters_posed", row.stats.characters_posed},
          {"rounds", row.frame_ms.size()},
          {"frame_ms", {{"min", *least}, {"median", median(row.frame_ms)}, {"max", *most}}},
          {"cpu_ms", median(row.cpu_ms)},
          {"vertex_invocations", invocations ? Json(*invocations) : Json(nullptr)},
          {"triangles", row.stats.triangles()},
          {"draw_calls", row.stats.drawCalls()},
          {"gpu_mesh_bytes", row.stats.gpu_mesh_bytes}};
}

/// A row's figures over those of the first technique (naive where it takes part) for as many people.
Json ratiosOf(const Row& row, const Row& base) {
  const auto ratio = [](double a, double b) { return b > 0.0 ? Json(a / b) : Json(nullptr); };
  Json ratios = {{"technique", toString(row.technique)},
                 {"versus", toString(base.technique)},
                 {"characters", row.characters},
                 {"frame_ms", ratio(median(row.frame_ms), median(base.frame_ms))},
                 {"cpu_ms", ratio(median(row.cpu_ms), median(base.cpu_ms))},
                 {"vertex_invocations", nullptr}};
  const auto own = row.stats.vertexInvocations(), others = base.stats.vertexInvocations();
  if (own && others)
    ratios["vertex_invocations"] = ratio(static_cast<double>(*own), static_cast<double>(*others));
  ratios["triangles"] =
      ratio(static_cast<double>(row.stats.triangles()), static_cast<double>(base.stats.triangles()));
  ratios["gpu_mesh_bytes"] =
      ratio(static_cast<double>(row.stats.gpu_mesh_bytes), static_cast<double>(base.stats.gpu_mesh_bytes));
  return ratios;
}

std::string toTableLine(const Row& row) {
  const auto [least, most] = std::minmax_element(row.frame_ms.begin(), row.frame_ms.end());
  const std::optional<std::uint64_t> invocations = row.stats.vertexInvocations();
  return fmt::format("{:<10} {:>8} {:>9.2f} {:>9.2f} {:>9.2f} {:>8.3f} {:>13} {:>13} {:>6} {:>11}\n",
                     toString(row.technique), row.characters, *least, median(row.frame_ms), *most,
                     median(row.cpu_ms), invocations ? std::to_string(*invocations) : "-",
                     row.stats.triangles(), row.stats.drawCalls(), row.stats.gpu_mesh_bytes);
}

std::string ratioText(const Json& ratios) {
  const auto text = [&](const char* key) {
    return ratios[key].is_null() ? std::string("-") : fmt::format("{:.3f}", ratios[key].get<double>());
  };
  return fmt::format("{} / {}, {} people: frame {}, vertices {}, triangles {}, mesh bytes {}\n",
                     ratios["technique"].get<std::string>(), ratios["versus"].get<std::string>(),
                     ratios["characters"].get<std::size_t>(), text("frame_ms"), text("vertex_invocations"),
                     text("triangles"), text("gpu_mesh_bytes"));
}

void run(const BenchArguments& arguments) {
  const std::vector<Technique> techniques = parseTechniques(arguments.techniques);
  const Scene scene = loadSceneOf(arguments.scene);
  const std::vector<Wardrobe> wardrobes = loadWardrobes(scene);
  const std::vector<std::string> counts = parseCounts(arguments.counts, scene);
  Json figures = {{"schema", "ensemble.bench/1"},    {"device", ""},
                  {"width", scene.output.width},     {"height", scene.output.height},
                  {"samples", scene.output.samples}, {"rows", Json::array()},
                  {"ratios", Json::array()}};
  std::string table =
      fmt::format("{:<10} {:>8} {:>9} {:>9} {:>9} {:>8} {:>13} {:>13} {:>6} {:>11}\n", "technique", "people",
                  "min ms", "median ms", "max ms", "cpu ms", "vertices", "triangles", "draws", "mesh bytes");
  std::string ratio_lines;
  Progress progress("rounds", std::uint64_t{arguments.rounds} * counts.size());
  for (const std::string& count : counts) {
    SceneArguments with_count = arguments.scene;
    with_count.overrides.push_back("crowd.count=" + count);
    Contest contest(arguments, loadSceneOf(with_count), wardrobes, techniques);
    for (std::uint32_t round = 0; round < arguments.rounds; ++round) {
      contest.runRound();
      progress.advance();
    }
    figures["device"] = contest.deviceName();
    const std::vector<Row>& rows = contest.rows();
    const auto naive = std::find_if(rows.begin(), rows.end(),
                                    [](const Row& row) { return row.technique == Technique::kNaive; });
    const Row& base = naive != rows.end() ? *naive : rows.front();
    for (const Row& row : rows) {
      figures["rows"].push_back(toJson(row));
      table += toTableLine(row);
      if (&row == &base) continue;
      figures["ratios"].push_back(ratiosOf(row, base));
      ratio_lines += ratioText(figures["ratios"].back());
    }
    contest.refuseMessages();
  }
  writeFigures(arguments.common, figures);
  printResult(arguments.common, table + ratio_lines);
}

}  // namespace

void addBenchCommand(CLI::App& app) {
  CLI::App& command =
      *app.add_subcommand("bench", "Compare the techniques' frame time, vertex work and memory");
  const auto arguments = std::make_shared<BenchArguments>();
  addSceneOptions(command, arguments->scene);
  command
      .add_option("--techniques", arguments->techniques,
                  "Which to compare: naive,prefitted,tagged (default: all)")
      ->type_name("LIST");
  command
      .add_option("--counts", arguments->counts,
                  "Numbers of people in the crowd; default: the scene's crowd.count")
      ->type_name("LIST");
  command.add_option("--rounds", arguments->rounds, "Frames of each technique, 1 to 10000; default 15")
      ->check(CLI::Range(1, 10000))
      ->type_name("N");
  finishCommand(command, arguments->common, "ensemble bench scene.yaml --counts 100,1000 --json bench.json",
                [arguments] { run(*arguments); });
}

}  // namespace ensemble::cli
