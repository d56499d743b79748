// Plots as SVG, for pages of html_page.h, whose style sheet colours them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ensemble::cli {

/// Where a line plot's data stand, in the SVG's units: a plot is 760 wide. Its height is 380.
struct PlotArea {
  double left = 90.0, right = 640.0, top = 50.0, bottom = 320.0;
};
inline constexpr PlotArea kLinePlotArea;
inline constexpr double kBarLeft = 250.0, kBarRight = 660.0;  ///< of a bar plot: 0 and the axis's end

struct PlotLabels {
  std::string title, x, y;  ///< axes with their units
};

struct PlotPoint {
  double x = 0.0, y = 0.0;
  std::optional<double> low = {}, high = {};  ///< spread of y
  bool marked = true;                         ///< shown as a mark with its figures as a tooltip
};

struct PlotSeries {
  std::string name, color;            ///< a colour of the page: "naive", "tagged", ...
  std::vector<PlotPoint> points;      ///< ascending in x
  std::optional<double> beyond = {};  ///< from this x on the line is dashed: not measured
};

/// A level to compare with.
struct ReferenceLine {
  double y = 0.0;
  std::string label;
};

/// The end of an axis from 0 that holds `greatest`, and the distance of its 4 to 8 ticks: 1, 2 or 5
/// times a power of ten.
struct Axis {
  double end = 1.0, step = 0.2;
};
Axis axisFor(double greatest);

/// Lines over x; both axes begin at 0. A point becomes an element of class "mark" (where marked) and
/// a place of its series' polyline, at left + x / end * (right - left), likewise up. Where points have
/// a spread, series i of n stands (i - (n - 1) / 2) * kMarkShift to the right, so that none hides another.
std::string linePlot(const PlotLabels& labels, std::span<const PlotSeries> series,
                     const std::optional<ReferenceLine>& reference = std::nullopt);
inline constexpr double kMarkShift = 7.0;

/// A bar of parts that lie one after the other; values are not negative.
struct Bar {
  std::string name;
  std::vector<double> parts;  ///< as many as the plot has parts
};
struct BarGroup {
  std::string name;
  std::vector<Bar> bars;
};
struct BarPart {
  std::string name, color;
};

/// Horizontal stacked bars in groups, one below the other, with each bar's sum at its end. Part i of a
/// bar is a rectangle of class "bar" from kBarLeft + (sum of parts before) / end * (kBarRight - kBarLeft).
/// The y label is not used.
std::string barPlot(const PlotLabels& labels, std::span<const BarPart> parts,
                    std::span<const BarGroup> groups);

}  // namespace ensemble::cli
