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

/// The middle one of the rounds' values, of two middle ones the lower: one that was counted.
template <class ValueOf>
auto middleOf(const ContestRow& row, const ValueOf& valueOf) {
  std::vector<decltype(valueOf(row.rounds.front()))> values;
  for (const FrameStats& stats : row.rounds) values.push_back(valueOf(stats));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <class ValueOf>
std::uint64_t sumOf(const ContestRow& row, const ValueOf& valueOf) {
  std::uint64_t sum = 0;
  for (const FrameStats& stats : row.rounds) sum += valueOf(stats);
  return sum;
}

std::vector<double> frameTimes(const ContestRow& row) {
  std::vector<double> times;
  for (const FrameStats& stats : row.rounds) times.push_back(stats.frame_ms);
  return times;
}

double medianCpuTime(const ContestRow& row) {
  std::vector<double> times;
  for (const FrameStats& stats : row.rounds) times.push_back(stats.cpu_ms);
  return median(times);
}

std::optional<std::uint64_t> vertexInvocations(const ContestRow& row) {
  return middleOf(row, [](const FrameStats& stats) { return stats.vertexInvocations(); });
}

std::uint64_t triangles(const ContestRow& row) {
  return middleOf(row, [](const FrameStats& stats) { return stats.triangles(); });
}

Json orNull(const std::optional<std::uint64_t>& count) { return count ? Json(*count) : Json(nullptr); }

Json ratio(double a, double b) { return b > 0.0 ? Json(a / b) : Json(nullptr); }
Json ratio(std::uint64_t a, std::uint64_t b) { return ratio(static_cast<double>(a), static_cast<double>(b)); }

Json environmentOf(const ContestRow& row) {
  const auto middle = [&](auto member) {
    return middleOf(row, [&](const FrameStats& stats) { return stats.environment.*member; });
  };
  return {{"vertex_invocations", orNull(middle(&PassStats::vertex_invocations))},
          {"triangles", middle(&PassStats::triangles)},
          {"draw_calls", middle(&PassStats::draw_calls)}};
}

/// Sums over the rounds; what is kept after the last.
Json posesOf(const ContestRow& row) {
  const auto sum = [&](auto member) {
    return sumOf(row, [&](const FrameStats& stats) { return stats.poses.*member; });
  };
  const std::uint64_t kept = sum(&PoseStats::kept), skinned = sum(&PoseStats::skinned);
  return {{"kept", kept},
          {"skinned", skinned},
          {"share_kept", ratio(kept, kept + skinned)},
          {"own", sum(&PoseStats::own)},
          {"skinned_vertices", sum(&PoseStats::skinned_vertices)},
          {"kept_bytes", row.rounds.back().poses.kept_bytes}};
}

Json shareOf(const ContestRow& row, auto part, auto whole) {
  return ratio(sumOf(row, [&](const FrameStats& stats) { return std::uint64_t{stats.*part}; }),
               sumOf(row, [&](const FrameStats& stats) { return std::uint64_t{stats.*whole}; }));
}

Json mediansOfParts(const ContestRow& row) {
  Json parts = Json::object();
  for (std::size_t part = 0; part < kFramePartCount; ++part) {
    std::vector<double> values;
    for (const FrameStats& stats : row.rounds) values.push_back(stats.parts_ms[part]);
    parts[kFramePartNames[part]] = median(values);
  }
  return parts;
}

Json toJson(const ContestRow& row) {
  const auto middle = [&](auto member) {
    return middleOf(row, [&](const FrameStats& stats) { return stats.*member; });
  };
  const std::vector<double> times = frameTimes(row);
  return {{"technique", toString(row.technique)},
          {"raster", toString(row.raster)},
          {"characters", row.characters},
          {"characters_drawn", middle(&FrameStats::characters_drawn)},
          {"characters_posed", middle(&FrameStats::characters_posed)},
          {"characters_computed", middle(&FrameStats::characters_computed)},
          {"triangles_computed", middle(&FrameStats::triangles_computed)},
          {"triangles_hidden", middle(&FrameStats::triangles_hidden)},
          {"share_of_people_computed",
           shareOf(row, &FrameStats::characters_computed, &FrameStats::characters_drawn)},
          {"share_of_triangles_computed",
           shareOf(row, &FrameStats::triangles_computed, &FrameStats::people_triangles)},
          {"culling", row.rounds.back().culled_on_device ? "device" : "host"},
          {"poses", posesOf(row)},
          {"pose_bytes", row.rounds.back().poses.kept_bytes},
          {"rounds", row.rounds.size()},
          {"frame_ms", spreadOf(times)},
          {"frame_ms_of_rounds", times},
          {"cpu_ms", medianCpuTime(row)},
          {"parts_ms", mediansOfParts(row)},
          {"vertex_invocations", orNull(vertexInvocations(row))},
          {"vertex_invocations_differ_by", row.invocations_differ_by},
          {"triangles", triangles(row)},
          {"draw_calls", middleOf(row, [](const FrameStats& stats) { return stats.drawCalls(); })},
          {"gpu_mesh_bytes", middle(&FrameStats::gpu_mesh_bytes)},
          {"environment_bytes", middle(&FrameStats::environment_bytes)},
          {"environment", environmentOf(row)}};
}

Json toJson(const ContestError& error) {
  return {{"technique", toString(error.technique)},
          {"raster", toString(error.raster)},
          {"versus_raster", toString(error.versus)},
          {"characters", error.characters},
          {"frames", error.frames},
          {"mean_share", ratio(error.sum_of_shares, error.frames)},
          {"worst_share", error.worst_share},
          {"worst_frame", error.worst_frame},
          {"most", error.most}};
}

/// A row's figures over those of another one for as many people.
Json ratiosOf(const ContestRow& row, const ContestRow& base) {
  const std::vector<double> own_times = frameTimes(row), base_times = frameTimes(base);
  std::vector<double> of_rounds;
  for (std::size_t round = 0; round < own_times.size(); ++round) {
    if (base_times[round] > 0.0) of_rounds.push_back(own_times[round] / base_times[round]);
  }
  const auto own = vertexInvocations(row), others = vertexInvocations(base);
  return {{"technique", toString(row.technique)},
          {"versus", toString(base.technique)},
          {"raster", toString(row.raster)},
          {"versus_raster", toString(base.raster)},
          {"characters", row.characters},
          {"frame_ms", ratio(median(own_times), median(base_times))},
          {"frame_ms_of_rounds", of_rounds.empty() ? Json(nullptr) : spreadOf(of_rounds)},
          {"cpu_ms", ratio(medianCpuTime(row), medianCpuTime(base))},
          {"vertex_invocations", own && others ? ratio(*own, *others) : Json(nullptr)},
          {"triangles", ratio(triangles(row), triangles(base))},
          {"gpu_mesh_bytes", ratio(row.rounds.front().gpu_mesh_bytes, base.rounds.front().gpu_mesh_bytes)}};
}

/// Those of one rasteriser, in order.
std::vector<const ContestRow*> rowsBy(std::span<const ContestRow> rows, RasterKind raster) {
  std::vector<const ContestRow*> found;
  for (const ContestRow& row : rows) {
    if (row.raster == raster) found.push_back(&row);
  }
  return found;
}

void addRatiosOfTechniques(const std::vector<const ContestRow*>& rows, Json& ratios) {
  const auto find = [&](Technique technique) -> const ContestRow* {
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const auto* row) { return row->technique == technique; });
    return found == rows.end() ? nullptr : *found;
  };
  const ContestRow* naive = find(Technique::kNaive);
  const ContestRow* base = naive ? naive : rows.front();
  for (const ContestRow* row : rows) {
    if (row != base) ratios.push_back(ratiosOf(*row, *base));
  }
  const ContestRow* tagged = find(Technique::kTagged);
  const ContestRow* prefitted = find(Technique::kPrefitted);
  if (tagged && prefitted && base != tagged && base != prefitted)
    ratios.push_back(ratiosOf(*tagged, *prefitted));
}

/// A number as JSON writes it, so that both files say the same; nothing for null.
std::string csvNumber(const Json& value) { return value.is_null() ? "" : value.dump(); }

std::string ratioText(const Json& value) {
  return value.is_null() ? "-" : fmt::format("{:.3f}", value.get<double>());
}

std::string percentText(const Json& share, int digits) {
  return share.is_null() ? "-" : fmt::format("{:.{}f}", 100.0 * share.get<double>(), digits);
}

std::string toTableLine(const Json& row) {
  const Json& frame = row["frame_ms"];
  const Json& invocations = row["vertex_invocations"];
  return fmt::format("{:<10} {:<9} {:>8} {:>9.2f} {:>9.2f} {:>9.2f} {:>8.3f} {:>13} {:>13} {:>6} {:>11}\n",
                     row["technique"].get<std::string>(), row["raster"].get<std::string>(),
                     row["characters"].get<std::size_t>(), frame["min"].get<double>(),
                     frame["median"].get<double>(), frame["max"].get<double>(), row["cpu_ms"].get<double>(),
                     invocations.is_null() ? "-" : invocations.dump(), row["triangles"].get<std::uint64_t>(),
                     row["draw_calls"].get<std::uint64_t>(), row["gpu_mesh_bytes"].get<std::uint64_t>());
}

/// What the compute rasteriser drew of a row; nothing where it drew nobody.
std::string computedLine(const Json& row) {
  if (row["characters_computed"] == 0) return "";
  const Json& poses = row["poses"];
  return fmt::format(
      "{} by {}, {} people: in compute {} % of the people drawn, {} % of their triangles; poses {} % kept, "
      "{} skinned in {} rounds, {:.1f} MiB\n",
      row["technique"].get<std::string>(), row["raster"].get<std::string>(),
      row["characters"].get<std::size_t>(), percentText(row["share_of_people_computed"], 1),
      percentText(row["share_of_triangles_computed"], 1), percentText(poses["share_kept"], 2),
      poses["skinned"].get<std::uint64_t>(), row["rounds"].get<std::size_t>(),
      poses["kept_bytes"].get<double>() / (1 << 20));
}

std::string toTableLineOfRatios(const Json& ratios) {
  const Json& of_rounds = ratios["frame_ms_of_rounds"];
  std::string text = fmt::format("{}, {} people: frame {}", nameOfRatio(ratios),
                                 ratios["characters"].get<std::size_t>(), ratioText(ratios["frame_ms"]));
  if (!of_rounds.is_null()) {
    text += fmt::format(" (by round {}, quartiles {} to {})", ratioText(of_rounds["median"]),
                        ratioText(of_rounds["q1"]), ratioText(of_rounds["q3"]));
  }
  return text + fmt::format(", vertices {}, triangles {}, mesh bytes {}\n",
                            ratioText(ratios["vertex_invocations"]), ratioText(ratios["triangles"]),
                            ratioText(ratios["gpu_mesh_bytes"]));
}

std::string errorLine(const Json& error) {
  return fmt::format(
      "{} by {} and {}, {} people: {} % of the pixels that people cover differ by more than {} of 255 in the "
      "worst of {} frames ({}), {} % in the mean, by {} at most\n",
      error["technique"].get<std::string>(), error["raster"].get<std::string>(),
      error["versus_raster"].get<std::string>(), error["characters"].get<std::size_t>(),
      percentText(error["worst_share"], 3), kUnseenDifference, error["frames"].get<std::uint32_t>(),
      error["worst_frame"].get<std::uint32_t>(), percentText(error["mean_share"], 3),
      error["most"].get<int>());
}

/// What a ratio is to: a technique, or a rasteriser.
std::string baseOf(const Json& ratios) {
  return ratios["raster"] == ratios["versus_raster"] ? ratios["versus"] : ratios["versus_raster"];
}

/// A value of each of figures[list], each once, in order.
template <class ValueOf>
std::vector<std::string> distinct(const Json& figures, const char* list, const ValueOf& valueOf) {
  std::vector<std::string> values;
  for (const Json& one : figures[list]) {
    const std::string value = valueOf(one);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

std::string csvRatios(const Json& figures, const Json& row, const std::string& base) {
  for (const Json& ratios : figures["ratios"]) {
    if (ratios["technique"] != row["technique"] || ratios["raster"] != row["raster"] ||
        ratios["characters"] != row["characters"] || baseOf(ratios) != base ||
        ratios["frame_ms_of_rounds"].is_null()) {
      continue;
    }
    const Json& of_rounds = ratios["frame_ms_of_rounds"];
    return "," + csvNumber(ratios["frame_ms"]) + "," + csvNumber(of_rounds["q1"]) + "," +
           csvNumber(of_rounds["median"]) + "," + csvNumber(of_rounds["q3"]);
  }
  return ",,,,";
}

std::string csvErrors(const Json& figures, const Json& row, const std::string& versus) {
  for (const Json& error : figures["picture_errors"]) {
    if (error["technique"] != row["technique"] || error["raster"] != row["raster"] ||
        error["characters"] != row["characters"] || error["versus_raster"] != versus) {
      continue;
    }
    return "," + csvNumber(error["worst_share"]) + "," + csvNumber(error["mean_share"]) + "," +
           csvNumber(error["most"]);
  }
  return ",,,";
}

}  // namespace

std::string nameOfRatio(const Json& ratios) {
  const std::string technique = ratios["technique"], raster = ratios["raster"];
  const std::string versus = ratios["versus"], versus_raster = ratios["versus_raster"];
  if (raster != versus_raster) return fmt::format("{} by {} / {}", technique, raster, versus_raster);
  return fmt::format("{} / {} by {}", technique, versus, raster);
}

void addContest(std::span<const ContestRow> rows, std::span<const ContestError> errors, Json& figures) {
  std::vector<RasterKind> rasters;
  for (const ContestRow& row : rows) {
    figures["rows"].push_back(toJson(row));
    if (std::find(rasters.begin(), rasters.end(), row.raster) == rasters.end()) rasters.push_back(row.raster);
  }
  for (const RasterKind raster : rasters) addRatiosOfTechniques(rowsBy(rows, raster), figures["ratios"]);
  for (std::size_t a = 0; a < rows.size(); ++a) {
    for (std::size_t b = a + 1; b < rows.size(); ++b) {
      if (rows[a].technique == rows[b].technique) figures["ratios"].push_back(ratiosOf(rows[a], rows[b]));
    }
  }
  for (const ContestError& error : errors) figures["picture_errors"].push_back(toJson(error));
}

std::string benchTable(const Json& figures) {
  std::string table = fmt::format("{:<10} {:<9} {:>8} {:>9} {:>9} {:>9} {:>8} {:>13} {:>13} {:>6} {:>11}\n",
                                  "technique", "raster", "people", "min ms", "median ms", "max ms", "cpu ms",
                                  "vertices", "triangles", "draws", "mesh bytes");
  for (const Json& row : figures["rows"]) table += toTableLine(row);
  for (const Json& ratios : figures["ratios"]) table += toTableLineOfRatios(ratios);
  for (const Json& row : figures["rows"]) table += computedLine(row);
  for (const Json& error : figures["picture_errors"]) table += errorLine(error);
  return table;
}

std::string benchCsv(const Json& figures) {
  constexpr const char* kSpread[] = {"min", "q1", "median", "q3", "max"};
  // Columns that are keys of a row's JSON.
  constexpr const char* kLeading[] = {"characters", "characters_drawn", "rounds"};
  constexpr const char* kCounts[] = {"cpu_ms",
                                     "vertex_invocations",
                                     "triangles",
                                     "draw_calls",
                                     "gpu_mesh_bytes",
                                     "characters_computed",
                                     "share_of_people_computed",
                                     "share_of_triangles_computed",
                                     "pose_bytes"};
  constexpr const char* kPoses[] = {"kept", "skinned"};
  const std::vector<std::string> bases = distinct(figures, "ratios", baseOf);
  const std::vector<std::string> compared =
      distinct(figures, "picture_errors", [](const Json& error) { return error["versus_raster"]; });
  std::string text = "technique";
  for (const char* key : kLeading) text += std::string(",") + key;
  for (const char* key : kSpread) text += std::string(",frame_ms_") + key;
  for (const char* key : kCounts) text += std::string(",") + key;
  for (const char* key : kPoses) text += std::string(",poses_") + key;
  text += ",raster";
  for (const std::string& base : bases)
    text += fmt::format(",frame_vs_{0},frame_vs_{0}_q1,frame_vs_{0}_median,frame_vs_{0}_q3", base);
  for (const std::string& raster : compared)
    text += fmt::format(",picture_vs_{0}_worst,picture_vs_{0}_mean,picture_vs_{0}_most", raster);
  text += "\n";
  for (const Json& row : figures["rows"]) {
    text += row["technique"].get<std::string>();
    for (const char* key : kLeading) text += "," + csvNumber(row[key]);
    for (const char* key : kSpread) text += "," + csvNumber(row["frame_ms"][key]);
    for (const char* key : kCounts) text += "," + csvNumber(row[key]);
    for (const char* key : kPoses) text += "," + csvNumber(row["poses"][key]);
    text += "," + row["raster"].get<std::string>();
    for (const std::string& base : bases) text += csvRatios(figures, row, base);
    for (const std::string& raster : compared) text += csvErrors(figures, row, raster);
    text += "\n";
  }
  return text;
}

}  // namespace ensemble::cli
