// Lister, Laycock and Day, figure 4: the three techniques over the size of the crowd.
#include "cli/bench_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

/// One series for each technique, in the order of the rows; `pointOf` gives none for what is not known.
template <class PointOf>
std::vector<PlotSeries> seriesOf(const Json& figures, PointOf pointOf) {
  std::vector<PlotSeries> all;
  for (const Json& row : figures["rows"]) {
    const std::string technique = row["technique"];
    auto series = std::find_if(all.begin(), all.end(),
                               [&](const PlotSeries& other) { return other.name == technique; });
    if (series == all.end()) series = all.insert(all.end(), PlotSeries{technique, technique, {}});
    if (const std::optional<PlotPoint> point = pointOf(row)) series->points.push_back(*point);
  }
  for (PlotSeries& series : all) {
    std::stable_sort(series.points.begin(), series.points.end(),
                     [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  }
  return all;
}

void addTimes(HtmlPage& page, const Json& figures) {
  page.addHeading("Frame time");
  const std::vector<PlotSeries> series = seriesOf(figures, [](const Json& row) {
    const Json& frame = row["frame_ms"];
    return std::optional(PlotPoint{.x = row["characters"].get<double>(),
                                   .y = frame["median"].get<double>(),
                                   .low = frame["min"].get<double>(),
                                   .high = frame["max"].get<double>()});
  });
  page.addFigure(
      linePlot({"Frame time by size of the crowd", "people", "ms a frame"}, series),
      "As in figure 4 of Lister, Laycock and Day. Marks are medians, whiskers reach from the fastest to "
      "the slowest round. The techniques stand a little apart so that none hides another.");
  std::vector<std::vector<std::string>> rows, ratios;
  for (const Json& row : figures["rows"]) {
    const Json& frame = row["frame_ms"];
    rows.push_back({row["technique"].get<std::string>(), countText(row["characters"]),
                    millisecondsText(frame["min"]), millisecondsText(frame["q1"]),
                    millisecondsText(frame["median"]), millisecondsText(frame["q3"]),
                    millisecondsText(frame["max"]), millisecondsText(row["cpu_ms"])});
  }
  page.addTable(
      "Frame times in milliseconds; \"CPU\" is the part before the device was given its work (median)",
      {"technique", "people", "least", "1st quartile", "median", "3rd quartile", "most", "CPU"}, rows);
  for (const Json& row : figures["ratios"]) {
    const Json& of_rounds = row["frame_ms_of_rounds"];
    const auto of = [&](const char* key) { return of_rounds.is_null() ? "-" : ratioText(of_rounds[key]); };
    ratios.push_back(
        {fmt::format("{} / {}", row["technique"].get<std::string>(), row["versus"].get<std::string>()),
         countText(row["characters"]), ratioText(row["frame_ms"]), of("q1"), of("median"), of("q3")});
  }
  page.addTable(
      "Ratios of frame times: of the medians, and quartiles of the ratios inside each round, which a slow "
      "moment of the machine moves less",
      {"ratio", "people", "of medians", "1st quartile", "median of rounds", "3rd quartile"}, ratios);
}

void addCounts(HtmlPage& page, const Json& figures) {
  page.addHeading("Work");
  const std::vector<PlotSeries> series = seriesOf(figures, [](const Json& row) -> std::optional<PlotPoint> {
    if (row["vertex_invocations"].is_null()) return std::nullopt;
    return PlotPoint{.x = row["characters"].get<double>(),
                     .y = row["vertex_invocations"].get<double>() / 1000.0};
  });
  if (std::any_of(series.begin(), series.end(), [](const PlotSeries& one) { return !one.points.empty(); })) {
    page.addFigure(
        linePlot({"Vertex invocations by size of the crowd", "people", "thousands a frame"}, series),
        "How often the vertex shader ran for one frame, shadows included. Tagged and pre-fitted lie "
        "on one another where they shade the same vertices.");
  } else {
    page.addParagraph("This device does not count vertex invocations.");
  }
  bool same = true;
  std::vector<std::vector<std::string>> rows;
  for (const Json& row : figures["rows"]) {
    same = same && row["vertex_invocations_differ_by"] == 0;
    rows.push_back({row["technique"].get<std::string>(), countText(row["characters"]),
                    countText(row["characters_drawn"]), countText(row["vertex_invocations"]),
                    countText(row["triangles"]), countText(row["draw_calls"]),
                    countText(row["gpu_mesh_bytes"])});
  }
  page.addTable(
      same ? "Counts of one frame, the same in every round"
           : "Counts of one frame, the same in every round but for the vertex invocations, which are those "
             "of the first",
      {"technique", "people", "of them drawn", "vertex invocations", "triangles", "draw calls", "mesh bytes"},
      rows);
}

}  // namespace

std::string benchPage(const Json& figures) {
  HtmlPage page("Three techniques compared: " + figures["scene"].get<std::string>());
  page.addParagraph(fmt::format(
      "Measured on {}, pictures of {} x {} pixels, samples a pixel: {}; {} interleaved rounds after one that "
      "is not counted. In a round each technique draws the same frame once, each round begins with another "
      "technique. In every round the pictures of tagged and pre-fitted, where both took part, were the same "
      "byte for byte.",
      figures["device"].get<std::string>(), figures["width"].get<int>(), figures["height"].get<int>(),
      figures["samples"].get<int>(), countText(figures["rounds"])));
  addTimes(page, figures);
  addCounts(page, figures);
  return page.text();
}

}  // namespace ensemble::cli
