// Lister, Laycock and Day, figure 4: the three techniques over the size of the crowd. Likewise the
// rasterisers.
#include "cli/bench_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/bench_figures.h"
#include "cli/html_page.h"
#include "cli/svg_plot.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string millisecondsText(const Json& value) { return fmt::format("{:.2f}", value.get<double>()); }

std::string countText(const Json& value) {
  return value.is_null() ? "-" : groupDigits(value.get<std::uint64_t>());
}

std::string ratioText(const Json& value) {
  return value.is_null() ? "-" : fmt::format("{:.3f}", value.get<double>());
}

std::string percentText(const Json& share, int digits) {
  return share.is_null() ? "-" : fmt::format("{:.{}f} %", 100.0 * share.get<double>(), digits);
}

/// The different values of a key of the rows, in order.
std::vector<std::string> valuesOf(const Json& figures, const char* key) {
  std::vector<std::string> values;
  for (const Json& row : figures["rows"]) {
    const std::string value = row[key];
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

bool comparesRasterisers(const Json& figures) { return valuesOf(figures, "raster").size() > 1; }

/// A row's first column.
std::string nameOf(const Json& figures, const Json& row) {
  const std::string technique = row["technique"];
  return comparesRasterisers(figures) ? technique + ", " + row["raster"].get<std::string>() : technique;
}

/// One series for each `series_key` ("technique", "raster") of the rows whose `same_key` is `same`, in the
/// order of the rows; `pointOf` gives none for what is not known.
template <class PointOf>
std::vector<PlotSeries> seriesOf(const Json& figures, const char* series_key, const char* same_key,
                                 const std::string& same, const PointOf& pointOf) {
  std::vector<PlotSeries> all;
  for (const Json& row : figures["rows"]) {
    if (row[same_key] != same) continue;
    const std::string name = row[series_key];
    auto series =
        std::find_if(all.begin(), all.end(), [&](const PlotSeries& other) { return other.name == name; });
    if (series == all.end()) series = all.insert(all.end(), PlotSeries{name, name, {}});
    if (const std::optional<PlotPoint> point = pointOf(row)) series->points.push_back(*point);
  }
  for (PlotSeries& series : all) {
    std::stable_sort(series.points.begin(), series.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  }
  return all;
}

PlotPoint timeOf(const Json& row) {
  const Json& frame = row["frame_ms"];
  return {.x = row["characters"].get<double>(),
          .y = frame["median"].get<double>(),
          .low = frame["min"].get<double>(),
          .high = frame["max"].get<double>()};
}

/// For each rasteriser the techniques, and where there are several rasterisers for each technique these.
void addPlotsOfTimes(HtmlPage& page, const Json& figures) {
  const std::vector<std::string> rasters = valuesOf(figures, "raster");
  const std::vector<std::string> techniques = valuesOf(figures, "technique");
  const std::string title = "Frame time by size of the crowd";
  if (rasters.size() == 1 || techniques.size() > 1) {
    for (const std::string& raster : rasters) {
      page.addFigure(
          linePlot({rasters.size() == 1 ? title : title + ", " + raster, "people", "ms a frame"},
                   seriesOf(figures, "technique", "raster", raster, timeOf)),
          "As in figure 4 of Lister, Laycock and Day. Marks are medians, whiskers reach from the fastest to "
          "the slowest round. The techniques stand a little apart so that none hides another.");
    }
  }
  if (rasters.size() == 1) return;
  for (const std::string& technique : techniques) {
    page.addFigure(linePlot({title + ", " + technique, "people", "ms a frame"},
                            seriesOf(figures, "raster", "technique", technique, timeOf)),
                   "The rasterisers, likewise.");
  }
}

void addTimes(HtmlPage& page, const Json& figures) {
  page.addHeading("Frame time");
  addPlotsOfTimes(page, figures);
  std::vector<std::vector<std::string>> rows, ratios;
  for (const Json& row : figures["rows"]) {
    const Json& frame = row["frame_ms"];
    rows.push_back({nameOf(figures, row), countText(row["characters"]), millisecondsText(frame["min"]),
                    millisecondsText(frame["q1"]), millisecondsText(frame["median"]),
                    millisecondsText(frame["q3"]), millisecondsText(frame["max"]),
                    millisecondsText(row["cpu_ms"])});
  }
  page.addTable(
      "Frame times in milliseconds; \"CPU\" is the part before the device was given its work (median)",
      {"row", "people", "least", "1st quartile", "median", "3rd quartile", "most", "CPU"}, rows);
  for (const Json& row : figures["ratios"]) {
    const Json& of_rounds = row["frame_ms_of_rounds"];
    const auto of = [&](const char* key) { return of_rounds.is_null() ? "-" : ratioText(of_rounds[key]); };
    ratios.push_back({nameOfRatio(row), countText(row["characters"]), ratioText(row["frame_ms"]), of("q1"),
                      of("median"), of("q3")});
  }
  page.addTable(
      "Ratios of frame times: of the medians, and quartiles of the ratios inside each round, which a slow "
      "moment of the machine moves less",
      {"ratio", "people", "of medians", "1st quartile", "median of rounds", "3rd quartile"}, ratios);
}

bool isNothing(const PlotSeries& series) {
  return std::all_of(series.points.begin(), series.points.end(),
                     [](const PlotPoint& point) { return point.y == 0.0; });
}

void addPlotsOfInvocations(HtmlPage& page, const Json& figures) {
  const auto point_of = [](const Json& row) -> std::optional<PlotPoint> {
    if (row["vertex_invocations"].is_null()) return std::nullopt;
    return PlotPoint{.x = row["characters"].get<double>(),
                     .y = row["vertex_invocations"].get<double>() / 1000.0};
  };
  const std::vector<std::string> rasters = valuesOf(figures, "raster");
  const std::string title = "Vertex invocations by size of the crowd";
  for (const std::string& raster : rasters) {
    const std::vector<PlotSeries> series = seriesOf(figures, "technique", "raster", raster, point_of);
    if (std::all_of(series.begin(), series.end(), [](const PlotSeries& one) { return one.points.empty(); })) {
      page.addParagraph("This device does not count vertex invocations.");
      return;
    }
    // Where all people are drawn in compute there is nothing to show.
    if (rasters.size() > 1 && std::all_of(series.begin(), series.end(), isNothing)) continue;
    page.addFigure(
        linePlot({rasters.size() == 1 ? title : title + ", " + raster, "people", "thousands a frame"},
                 series),
        "How often the vertex shader ran for one frame, shadows included; for people drawn in compute it "
        "does "
        "not run. Tagged and pre-fitted lie on one another where they shade the same vertices.");
  }
}

void addCounts(HtmlPage& page, const Json& figures) {
  page.addHeading("Work");
  addPlotsOfInvocations(page, figures);
  bool same = true;
  std::vector<std::vector<std::string>> rows;
  for (const Json& row : figures["rows"]) {
    same = same && row["vertex_invocations_differ_by"] == 0;
    rows.push_back({nameOf(figures, row), countText(row["characters"]), countText(row["characters_drawn"]),
                    countText(row["vertex_invocations"]), countText(row["triangles"]),
                    countText(row["draw_calls"]), countText(row["gpu_mesh_bytes"])});
  }
  const bool is_still = figures["frames"].size() == 1;
  page.addTable(
      std::string(is_still
                      ? "Counts of one frame, the same in every round"
                      : "Counts of a frame: those of the middle one of the rounds. A frame has the same in "
                        "every round") +
          (same ? "" : " but for the vertex invocations"),
      {"row", "people", "of them drawn", "vertex invocations", "triangles", "draw calls", "mesh bytes"},
      rows);
}

void addComputed(HtmlPage& page, const Json& figures) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& row : figures["rows"]) {
    if (row["characters_computed"] == 0) continue;
    const Json& poses = row["poses"];
    rows.push_back(
        {nameOf(figures, row), countText(row["characters"]), percentText(row["share_of_people_computed"], 1),
         percentText(row["share_of_triangles_computed"], 1), countText(poses["kept"]),
         countText(poses["skinned"]), percentText(poses["share_kept"], 2), countText(poses["kept_bytes"])});
  }
  if (rows.empty()) return;
  page.addHeading("Drawn in compute");
  page.addTable(
      "What the compute rasteriser drew: its share of the people in sight and of their triangles in the "
      "picture; "
      "poses (a mesh at a key frame) that it found kept or had to skin, in all counted rounds; bytes kept "
      "after them",
      {"row", "people", "share of people", "of triangles", "poses kept", "skinned", "share kept", "bytes"},
      rows);
}

void addErrors(HtmlPage& page, const Json& figures) {
  std::vector<std::vector<std::string>> rows;
  for (const Json& error : figures["picture_errors"]) {
    rows.push_back(
        {fmt::format("{}, {} and {}", error["technique"].get<std::string>(),
                     error["raster"].get<std::string>(), error["versus_raster"].get<std::string>()),
         countText(error["characters"]), countText(error["frames"]), percentText(error["worst_share"], 3),
         countText(error["worst_frame"]), percentText(error["mean_share"], 3), countText(error["most"])});
  }
  if (rows.empty()) return;
  page.addHeading("How far pictures are apart");
  page.addTable(
      fmt::format("Pixels of which a channel differs by more than {} of 255, by the pixels that people "
                  "cover; and the greatest difference of any channel",
                  kUnseenDifference),
      {"pictures", "people", "frames", "worst frame", "its number", "mean", "greatest difference"}, rows);
}

std::string framesText(const Json& frames) {
  const auto number = [](const Json& frame) { return frame.get<std::uint32_t>(); };
  if (frames.size() == 1) return fmt::format("frame {} of the scene", number(frames.front()));
  return fmt::format("{} frames of the scene ({} to {}) in turn", frames.size(), number(frames.front()),
                     number(frames.back()));
}

}  // namespace

std::string benchPage(const Json& figures) {
  HtmlPage page((comparesRasterisers(figures) ? "Techniques and rasterisers compared: "
                                              : "Three techniques compared: ") +
                figures["scene"].get<std::string>());
  page.addParagraph(fmt::format(
      "Measured on {}, pictures of {} x {} pixels, samples a pixel: {}; {}. {} interleaved rounds after {} "
      "not "
      "counted. In a round each row below draws the same frame once, each round begins with another one. In "
      "every round the pictures of tagged and pre-fitted, where both took part, were the same byte for byte, "
      "and "
      "each frame's picture was the same as often as it was drawn.",
      figures["device"].get<std::string>(), figures["width"].get<int>(), figures["height"].get<int>(),
      figures["samples"].get<int>(), framesText(figures["frames"]), countText(figures["rounds"]),
      countText(figures["warm_up_rounds"])));
  addTimes(page, figures);
  addCounts(page, figures);
  addComputed(page, figures);
  addErrors(page, figures);
  return page.text();
}

}  // namespace ensemble::cli
