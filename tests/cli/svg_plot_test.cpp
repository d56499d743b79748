// Plots: every datum stands where it must.
#include "cli/svg_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

namespace ensemble::cli {
namespace {

using ::testing::HasSubstr;
using Place = std::pair<double, double>;

/// Where the marks of a plot stand, in its order.
std::vector<Place> marksOf(const std::string& svg) {
  static const std::regex kMark(R"re(class="mark [^"]*" data-x="([^"]*)" data-y="([^"]*)")re");
  std::vector<Place> places;
  for (std::sregex_iterator mark(svg.begin(), svg.end(), kMark), end; mark != end; ++mark)
    places.emplace_back(std::stod((*mark)[1]), std::stod((*mark)[2]));
  return places;
}

/// The corners of the polylines of a plot.
std::vector<std::vector<Place>> linesOf(const std::string& svg) {
  static const std::regex kLine(R"re(<polyline points="([^"]*)")re"), kPlace(R"re(([0-9.]+),([0-9.]+))re");
  std::vector<std::vector<Place>> lines;
  for (std::sregex_iterator line(svg.begin(), svg.end(), kLine), end; line != end; ++line) {
    const std::string points = (*line)[1];
    std::vector<Place>& places = lines.emplace_back();
    for (std::sregex_iterator place(points.begin(), points.end(), kPlace); place != end; ++place)
      places.emplace_back(std::stod((*place)[1]), std::stod((*place)[2]));
  }
  return lines;
}

/// Left, width of each bar's parts.
std::vector<Place> barsOf(const std::string& svg) {
  static const std::regex kBar(R"re(<rect x="([^"]*)" y="[^"]*" width="([^"]*)" height="15" class="bar )re");
  std::vector<Place> bars;
  for (std::sregex_iterator bar(svg.begin(), svg.end(), kBar), end; bar != end; ++bar)
    bars.emplace_back(std::stod((*bar)[1]), std::stod((*bar)[2]));
  return bars;
}

void expectPlaces(const std::vector<Place>& places, const std::vector<Place>& expected) {
  ASSERT_EQ(places.size(), expected.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(places[i].first, expected[i].first, 0.006) << i;
    EXPECT_NEAR(places[i].second, expected[i].second, 0.006) << i;
  }
}

TEST(SvgPlot, AxesHoldTheirDataWithFewRoundTicks) {
  EXPECT_EQ(axisFor(0.0).end, 1.0);
  EXPECT_EQ(axisFor(NAN).end, 1.0);
  for (const double greatest : {0.003, 0.7, 1.0, 3.9, 4.0, 17.0, 100.0, 344240.0, 1e9}) {
    const Axis axis = axisFor(greatest);
    const double ticks = axis.end / axis.step;
    EXPECT_GE(axis.end, greatest * (1 - 1e-9));
    EXPECT_LT(axis.end - greatest, axis.step * (1 + 1e-9)) << "no empty room";
    EXPECT_NEAR(ticks, std::round(ticks), 1e-9);
    EXPECT_GE(ticks, 4 - 1e-9) << greatest;
    EXPECT_LE(ticks, 8 + 1e-9) << greatest;
  }
}

TEST(SvgPlot, LinesStandWhereTheirDataDo) {
  // The axes end at 100 and at 8, so a place is a share of the area: 90 to 640, 320 up to 50.
  const std::vector<PlotSeries> series = {
      {"one", "naive", {{.x = 0, .y = 0}, {.x = 50, .y = 4, .marked = false}, {.x = 100, .y = 8}}},
      {"two", "tagged", {{.x = 25, .y = 2}, {.x = 50, .y = 1}, {.x = 75, .y = 2}}, 50.0}};
  const std::string svg = linePlot({"t", "people", "ms"}, series);
  expectPlaces(marksOf(svg), {{90, 320}, {640, 50}, {227.5, 252.5}, {365, 286.25}, {502.5, 252.5}});
  const auto lines = linesOf(svg);
  ASSERT_EQ(lines.size(), 3u) << "the second series goes on dashed";
  expectPlaces(lines[0], {{90, 320}, {365, 185}, {640, 50}});
  expectPlaces(lines[1], {{227.5, 252.5}, {365, 286.25}});
  expectPlaces(lines[2], {{365, 286.25}, {502.5, 252.5}});
  EXPECT_THAT(svg, HasSubstr("class=\"line beyond stroke-tagged\""));
  EXPECT_THAT(svg, HasSubstr(">people</text>"));
  EXPECT_THAT(svg, HasSubstr(">ms</text>"));
}

TEST(SvgPlot, SpreadsReachFromLowToHigh) {
  const std::vector<PlotSeries> series = {{"one", "naive", {{.x = 4, .y = 2, .low = 1, .high = 4}}},
                                          {"two", "tagged", {{.x = 4, .y = 2, .low = 2, .high = 3}}}};
  const std::string svg = linePlot({"t", "x", "y"}, series);
  expectPlaces(marksOf(svg), {{640 - 3.5, 185}, {640 + 3.5, 185}});
  EXPECT_THAT(svg, HasSubstr("<line x1=\"636.50\" y1=\"252.50\" x2=\"636.50\" y2=\"50.00\" class=\"spread"));
  EXPECT_THAT(svg, HasSubstr("<line x1=\"643.50\" y1=\"185.00\" x2=\"643.50\" y2=\"117.50\" class=\"spread"));
  EXPECT_THAT(svg, HasSubstr("<title>one: 2 at 4, from 1 to 4</title>"));
  EXPECT_TRUE(linesOf(svg).empty()) << "one point makes no line";
}

TEST(SvgPlot, BarsAreAsLongAsTheirParts) {
  const std::vector<BarPart> parts = {{"a", "template"}, {"b", "garments"}, {"c", "fitted"}};
  const std::vector<BarGroup> groups = {{"g", {{"x", {20, 40, 20}}, {"y", {0, 80, 0}}}}};
  // The axis ends at 80, and is 410 long.
  const std::string svg = barPlot({"t", "faces", ""}, parts, groups);
  expectPlaces(barsOf(svg), {{250, 102.5}, {352.5, 205}, {557.5, 102.5}, {250, 410}});
  EXPECT_THAT(svg, HasSubstr("<title>g, x: b 40</title>"));
  EXPECT_THAT(svg, HasSubstr(">80</text>")) << "the sum";
}

TEST(SvgPlot, NothingGivesAnEmptyPlot) {
  EXPECT_TRUE(marksOf(linePlot({"t", "x", "y"}, {})).empty());
  EXPECT_TRUE(barsOf(barPlot({"t", "x", "y"}, {}, {})).empty());
}

}  // namespace
}  // namespace ensemble::cli
