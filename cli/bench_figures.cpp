#include "cli/bench_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/stats.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

Json spreadOf(const std::vector<double>& values) {
  return {{"min", quantile(values, 0.0)},
          {"q1", quantile(values, 0.25)},
          {"median", median(values)},
          {"q3", quantile(values, 0.75)},
          {"max", quantile(values, 1.0)}};
}

Json toJson(const PassStats& environment) {
  const std::optional<std::uint64_t> invocations = environment.vertex_invocations;
  return {{"vertex_invocations", invocations ? Json(*invocations) : Json(nullptr)},
          {"triangles", environment.triangles},
          {"draw_calls", environment.draw_calls}};
}

Json mediansOfParts(const std::vector<PartTimes>& rounds) {
  Json parts = Json::object();
  for (std::size_t part = 0; part < kFramePartCount; ++part) {
    std::vector<double> values;
    for (const PartTimes& round : rounds) values.push_back(round[part]);
    parts[kFramePartNames[part]] = values.empty() ? 0.0 : median(values);
  }
  return parts;
}

Json toJson(const ContestRow& row) {
  const FrameStats& stats = row.stats;
  const std::optional<std::uint64_t> invocations = stats.vertexInvocations();
  return {{"technique", toString(row.technique)},
          {"characters", row.characters},
          {"characters_drawn", stats.characters_drawn},
          {"characters_posed", stats.characters_posed},
          {"characters_computed", stats.characters_computed},
          {"triangles_computed", stats.triangles_computed},
          {"pose_bytes", stats.poses.kept_bytes},
          {"rounds", row.frame_ms.size()},
          {"frame_ms", spreadOf(row.frame_ms)},
          {"frame_ms_of_rounds", row.frame_ms},
          {"cpu_ms", median(row.cpu_ms)},
          {"parts_ms", mediansOfParts(row.parts_ms)},
          {"vertex_invocations", invocations ? Json(*invocations) : Json(nullptr)},
          {"vertex_invocations_differ_by", row.most_invocations - row.least_invocations},
          {"triangles", stats.triangles()},
          {"draw_calls", stats.drawCalls()},
          {"gpu_mesh_bytes", stats.gpu_mesh_bytes},
          {"environment_bytes", stats.environment_bytes},
          {"environment", toJson(stats.environment)}};
}

Json ratio(double a, double b) { return b > 0.0 ? Json(a / b) : Json(nullptr); }
Json ratio(std::uint64_t a, std::uint64_t b) { return ratio(static_cast<double>(a), static_cast<double>(b)); }

/// A row's figures over those of another technique for as many people.
Json ratiosOf(const ContestRow& row, const ContestRow& base) {
  std::vector<double> of_rounds;
  for (std::size_t round = 0; round < row.frame_ms.size(); ++round) {
    if (base.frame_ms[round] > 0.0) of_rounds.push_back(row.frame_ms[round] / base.frame_ms[round]);
  }
  const auto own = row.stats.vertexInvocations(), others = base.stats.vertexInvocations();
  return {{"technique", toString(row.technique)},
          {"versus", toString(base.technique)},
          {"characters", row.characters},
          {"frame_ms", ratio(median(row.frame_ms), median(base.frame_ms))},
          {"frame_ms_of_rounds", of_rounds.empty() ? Json(nullptr) : spreadOf(of_rounds)},
          {"cpu_ms", ratio(median(row.cpu_ms), median(base.cpu_ms))},
          {"vertex_invocations", own && others ? ratio(*own, *others) : Json(nullptr)},
          {"triangles", ratio(row.stats.triangles(), base.stats.triangles())},
          {"gpu_mesh_bytes", ratio(row.stats.gpu_mesh_bytes, base.stats.gpu_mesh_bytes)}};
}

const ContestRow* find(std::span<const ContestRow> rows, Technique technique) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const ContestRow& row) { return row.technique == technique; });
  return found == rows.end() ? nullptr : &*found;
}

/// A number as JSON writes it, so that both files say the same; nothing for null.
std::string csvNumber(const Json& value) { return value.is_null() ? "" : value.dump(); }

std::string ratioText(const Json& value) {
  return value.is_null() ? "-" : fmt::format("{:.3f}", value.get<double>());
}

std::string toTableLine(const Json& row) {
  const Json& frame = row["frame_ms"];
  const Json& invocations = row["vertex_invocations"];
  return fmt::format("{:<10} {:>8} {:>9.2f} {:>9.2f} {:>9.2f} {:>8.3f} {:>13} {:>13} {:>6} {:>11}\n",
                     row["technique"].get<std::string>(), row["characters"].get<std::size_t>(),
                     frame["min"].get<double>(), frame["median"].get<double>(), frame["max"].get<double>(),
                     row["cpu_ms"].get<double>(), invocations.is_null() ? "-" : invocations.dump(),
                     row["triangles"].get<std::uint64_t>(), row["draw_calls"].get<std::uint64_t>(),
                     row["gpu_mesh_bytes"].get<std::uint64_t>());
}

std::string toTableLineOfRatios(const Json& ratios) {
  const Json& of_rounds = ratios["frame_ms_of_rounds"];
  std::string text = fmt::format("{} / {}, {} people: frame {}", ratios["technique"].get<std::string>(),
                                 ratios["versus"].get<std::string>(), ratios["characters"].get<std::size_t>(),
                                 ratioText(ratios["frame_ms"]));
  if (!of_rounds.is_null()) {
    text += fmt::format(" (by round {}, quartiles {} to {})", ratioText(of_rounds["median"]),
                        ratioText(of_rounds["q1"]), ratioText(of_rounds["q3"]));
  }
  return text + fmt::format(", vertices {}, triangles {}, mesh bytes {}\n",
                            ratioText(ratios["vertex_invocations"]), ratioText(ratios["triangles"]),
                            ratioText(ratios["gpu_mesh_bytes"]));
}

/// The techniques that ratios are to, each once, in order.
std::vector<std::string> basesOf(const Json& figures) {
  std::vector<std::string> bases;
  for (const Json& ratios : figures["ratios"]) {
    const std::string base = ratios["versus"];
    if (std::find(bases.begin(), bases.end(), base) == bases.end()) bases.push_back(base);
  }
  return bases;
}

std::string csvRatios(const Json& figures, const Json& row, const std::string& base) {
  for (const Json& ratios : figures["ratios"]) {
    if (ratios["technique"] != row["technique"] || ratios["characters"] != row["characters"] ||
        ratios["versus"] != base || ratios["frame_ms_of_rounds"].is_null()) {
      continue;
    }
    const Json& of_rounds = ratios["frame_ms_of_rounds"];
    return "," + csvNumber(ratios["frame_ms"]) + "," + csvNumber(of_rounds["q1"]) + "," +
           csvNumber(of_rounds["median"]) + "," + csvNumber(of_rounds["q3"]);
  }
  return ",,,,";
}

}  // namespace

void addContest(std::span<const ContestRow> rows, Json& figures) {
  const ContestRow* naive = find(rows, Technique::kNaive);
  const ContestRow& base = naive ? *naive : rows.front();
  for (const ContestRow& row : rows) {
    figures["rows"].push_back(toJson(row));
    if (&row != &base) figures["ratios"].push_back(ratiosOf(row, base));
  }
  const ContestRow* tagged = find(rows, Technique::kTagged);
  const ContestRow* prefitted = find(rows, Technique::kPrefitted);
  if (tagged && prefitted && &base != tagged && &base != prefitted)
    figures["ratios"].push_back(ratiosOf(*tagged, *prefitted));
}

std::string benchTable(const Json& figures) {
  std::string table =
      fmt::format("{:<10} {:>8} {:>9} {:>9} {:>9} {:>8} {:>13} {:>13} {:>6} {:>11}\n", "technique", "people",
                  "min ms", "median ms", "max ms", "cpu ms", "vertices", "triangles", "draws", "mesh bytes");
  for (const Json& row : figures["rows"]) table += toTableLine(row);
  for (const Json& ratios : figures["ratios"]) table += toTableLineOfRatios(ratios);
  return table;
}

std::string benchCsv(const Json& figures) {
  constexpr const char* kCounts[] = {"cpu_ms", "vertex_invocations", "triangles", "draw_calls",
                                     "gpu_mesh_bytes"};
  constexpr const char* kSpread[] = {"min", "q1", "median", "q3", "max"};
  std::string text = "technique,characters,characters_drawn,rounds";
  for (const char* key : kSpread) text += std::string(",frame_ms_") + key;
  for (const char* key : kCounts) text += std::string(",") + key;
  const std::vector<std::string> bases = basesOf(figures);
  for (const std::string& base : bases) {
    text += fmt::format(",frame_vs_{0},frame_vs_{0}_q1,frame_vs_{0}_median,frame_vs_{0}_q3", base);
  }
  text += "\n";
  for (const Json& row : figures["rows"]) {
    text += fmt::format("{},{},{},{}", row["technique"].get<std::string>(), row["characters"].dump(),
                        row["characters_drawn"].dump(), row["rounds"].dump());
    for (const char* key : kSpread) text += "," + csvNumber(row["frame_ms"][key]);
    for (const char* key : kCounts) text += "," + csvNumber(row[key]);
    for (const std::string& base : bases) text += csvRatios(figures, row, base);
    text += "\n";
  }
  return text;
}

}  // namespace ensemble::cli
