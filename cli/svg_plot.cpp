#include "cli/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/html_page.h"
#include "core/check.h"

namespace ensemble::cli {
namespace {

constexpr double kWidth = 760.0, kLineHeight = 380.0;
constexpr double kBarHeight = 15.0, kGroupGap = 12.0;

/// A figure for people: at most four digits that matter, large ones grouped.
std::string figureText(double value) {
  if (std::abs(value) >= 1000.0) {
    return (value < 0 ? "-" : "") + groupDigits(static_cast<std::uint64_t>(std::llround(std::abs(value))));
  }
  return fmt::format("{:.4g}", value);
}

std::string textAt(double x, double y, const std::string& attributes, const std::string& text) {
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", x, y, attributes, escapeXml(text));
}

std::string lineBetween(double x0, double y0, double x1, double y1, const std::string& classes) {
  return fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" class=\"{}\"/>\n", x0, y0,
                     x1, y1, classes);
}

std::string open(const std::string& title, double height) {
  const std::string name = escapeXml(title);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" "
      "aria-label=\"{}\">\n<text x=\"0\" y=\"18\" class=\"title\">{}</text>\n",
      kWidth, height, name, name);
}

/// A circle, square or diamond of the i-th series, with its figures as a tooltip.
std::string markAt(std::size_t i, double x, double y, const std::string& color, const std::string& tip) {
  const std::string attributes =
      fmt::format("class=\"mark fill-{}\" data-x=\"{:.2f}\" data-y=\"{:.2f}\"", escapeXml(color), x, y);
  const std::string title = "<title>" + escapeXml(tip) + "</title>";
  if (i % 3 == 0) {
    return fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"4.5\" {}>{}</circle>\n", x, y, attributes,
                       title);
  }
  if (i % 3 == 1) {
    return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"8\" height=\"8\" {}>{}</rect>\n", x - 4,
                       y - 4, attributes, title);
  }
  return fmt::format("<path d=\"M{:.2f} {:.2f}l5.5 5.5l-5.5 5.5l-5.5 -5.5z\" {}>{}</path>\n", x, y - 5.5,
                     attributes, title);
}

class LinePlot {
 public:
  LinePlot(const PlotLabels& labels, std::span<const PlotSeries> series,
           const std::optional<ReferenceLine>& reference)
      : labels_(labels), series_(series), reference_(reference) {
    double greatest_x = 0.0, greatest_y = reference ? reference->y : 0.0;
    for (const PlotSeries& one : series) {
      for (const PlotPoint& point : one.points) {
        greatest_x = std::max(greatest_x, point.x);
        greatest_y = std::max(greatest_y, point.high.value_or(point.y));
        has_spread_ = has_spread_ || point.low || point.high;
      }
    }
    x_axis_ = axisFor(greatest_x);
    y_axis_ = axisFor(greatest_y);
  }

  std::string draw() {
    svg_ = open(labels_.title, kLineHeight);
    drawAxes();
    if (reference_) drawReference();
    for (std::size_t i = 0; i < series_.size(); ++i) drawSeries(i);
    drawNames();
    return svg_ + "</svg>\n";
  }

 private:
  double xOf(double x) const { return area_.left + x / x_axis_.end * (area_.right - area_.left); }
  double yOf(double y) const { return area_.bottom - y / y_axis_.end * (area_.bottom - area_.top); }

  void drawAxes() {
    for (double y = 0.0; y <= y_axis_.end * 1.0001; y += y_axis_.step) {
      svg_ += lineBetween(area_.left, yOf(y), area_.right, yOf(y), "grid");
      svg_ += textAt(area_.left - 8, yOf(y) + 4, "class=\"faint\" text-anchor=\"end\"", figureText(y));
    }
    for (double x = 0.0; x <= x_axis_.end * 1.0001; x += x_axis_.step) {
      svg_ += lineBetween(xOf(x), area_.bottom, xOf(x), area_.bottom + 5, "axis");
      svg_ += textAt(xOf(x), area_.bottom + 20, "class=\"faint\" text-anchor=\"middle\"", figureText(x));
    }
    svg_ += lineBetween(area_.left, area_.bottom, area_.right, area_.bottom, "axis");
    svg_ += textAt(0.5 * (area_.left + area_.right), area_.bottom + 44, "text-anchor=\"middle\"", labels_.x);
    const double middle = 0.5 * (area_.top + area_.bottom);
    svg_ += textAt(16, middle, fmt::format("text-anchor=\"middle\" transform=\"rotate(-90 16 {})\"", middle),
                   labels_.y);
  }

  void drawReference() {
    svg_ += lineBetween(area_.left, yOf(reference_->y), area_.right, yOf(reference_->y), "reference");
    svg_ += textAt(area_.right - 4, yOf(reference_->y) + 16, "class=\"faint\" text-anchor=\"end\"",
                   reference_->label);
  }

  void drawSeries(std::size_t i) {
    const PlotSeries& series = series_[i];
    const std::string color = escapeXml(series.color);
    shift_ = has_spread_
                 ? (static_cast<double>(i) - 0.5 * static_cast<double>(series_.size() - 1)) * kMarkShift
                 : 0.0;
    drawLine(series, "line stroke-" + color, [&](double x) { return !series.beyond || x <= *series.beyond; });
    if (series.beyond) {
      drawLine(series, "line beyond stroke-" + color, [&](double x) { return x >= *series.beyond; });
    }
    for (const PlotPoint& point : series.points) {
      if (!point.marked) continue;
      const double x = xOf(point.x) + shift_;
      std::string tip = fmt::format("{}: {} at {}", series.name, figureText(point.y), figureText(point.x));
      if (point.low || point.high) {
        const double low = point.low.value_or(point.y), high = point.high.value_or(point.y);
        svg_ += lineBetween(x, yOf(low), x, yOf(high), "spread stroke-" + color);
        for (const double end : {low, high})
          svg_ += lineBetween(x - 3, yOf(end), x + 3, yOf(end), "spread stroke-" + color);
        tip += fmt::format(", from {} to {}", figureText(low), figureText(high));
      }
      svg_ += markAt(i, x, yOf(point.y), series.color, tip);
    }
  }

  template <class Belongs>
  void drawLine(const PlotSeries& series, const std::string& classes, Belongs belongs) {
    std::string places;
    for (const PlotPoint& point : series.points) {
      if (!belongs(point.x)) continue;
      places +=
          fmt::format("{}{:.2f},{:.2f}", places.empty() ? "" : " ", xOf(point.x) + shift_, yOf(point.y));
    }
    if (places.find(' ') == std::string::npos) return;  // a line takes two points
    svg_ += fmt::format("<polyline points=\"{}\" class=\"{}\"/>\n", places, classes);
  }

  /// Names stand at the lines' ends, moved apart where they would overlap.
  void drawNames() {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < series_.size(); ++i) {
      if (!series_[i].points.empty()) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return series_[a].points.back().y < series_[b].points.back().y;
    });
    double free_below = area_.bottom;
    for (const std::size_t i : order) {
      const PlotPoint& last = series_[i].points.back();
      const double y = std::min(yOf(last.y), free_below);
      free_below = y - 17.0;
      svg_ += markAt(i, area_.right + 24, y, series_[i].color, series_[i].name);
      svg_.replace(svg_.rfind("class=\"mark "), 12, "class=\"key ");
      svg_ += textAt(area_.right + 34, y + 4, "", series_[i].name);
    }
  }

  const PlotLabels& labels_;
  std::span<const PlotSeries> series_;
  const std::optional<ReferenceLine>& reference_;
  const PlotArea area_ = kLinePlotArea;
  Axis x_axis_, y_axis_;
  bool has_spread_ = false;
  double shift_ = 0.0;  ///< of the series that is being drawn
  std::string svg_;
};

std::string drawKey(std::span<const BarPart> parts) {
  std::string svg;
  double x = kBarLeft;
  for (const BarPart& part : parts) {
    svg += fmt::format("<rect x=\"{:.2f}\" y=\"30\" width=\"11\" height=\"11\" class=\"fill-{}\"/>\n", x,
                       escapeXml(part.color));
    svg += textAt(x + 16, 40, "", part.name);
    x += 30.0 + 7.5 * static_cast<double>(part.name.size());
  }
  return svg;
}

std::string drawBar(const Bar& bar, const std::string& group, std::span<const BarPart> parts, double y,
                    double units_per_value) {
  ENSEMBLE_CHECK(bar.parts.size() == parts.size());
  std::string svg =
      textAt(kBarLeft - 8, y + 0.8 * kBarHeight, "class=\"faint\" text-anchor=\"end\"", bar.name);
  double sum = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double value = bar.parts[p];
    if (value > 0.0) {
      svg += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{}\" class=\"bar fill-{}\">"
          "<title>{}</title></rect>\n",
          kBarLeft + sum * units_per_value, y, value * units_per_value, kBarHeight, escapeXml(parts[p].color),
          escapeXml(fmt::format("{}, {}: {} {}", group, bar.name, parts[p].name, figureText(value))));
    }
    sum += value;
  }
  return svg + textAt(kBarLeft + sum * units_per_value + 6, y + 0.8 * kBarHeight, "class=\"faint\"",
                      figureText(sum));
}

/// A name that fits beside the bars; the tooltip and the table have it whole.
std::string shortened(const std::string& name) {
  constexpr std::size_t kLetters = 24;
  if (name.size() <= kLetters) return name;
  std::size_t end = kLetters - 1;
  while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // whole UTF-8 letters
  return name.substr(0, end) + "…";
}

}  // namespace

Axis axisFor(double greatest) {
  if (!(greatest > 0.0)) return {};
  const double power = std::pow(10.0, std::floor(std::log10(greatest / 4.0)));
  double step = power;
  for (const double factor : {2.0, 5.0, 10.0}) {
    if (greatest / step > 8.0) step = factor * power;
  }
  return {std::ceil(greatest / step - 1e-9) * step, step};
}

std::string linePlot(const PlotLabels& labels, std::span<const PlotSeries> series,
                     const std::optional<ReferenceLine>& reference) {
  return LinePlot(labels, series, reference).draw();
}

std::string barPlot(const PlotLabels& labels, std::span<const BarPart> parts,
                    std::span<const BarGroup> groups) {
  double greatest = 0.0, height = 60.0;
  for (const BarGroup& group : groups) {
    for (const Bar& bar : group.bars) {
      double sum = 0.0;
      for (const double part : bar.parts) sum += part;
      greatest = std::max(greatest, sum);
    }
    height += static_cast<double>(group.bars.size()) * kBarHeight + kGroupGap;
  }
  const Axis axis = axisFor(greatest);
  const double units_per_value = (kBarRight - kBarLeft) / axis.end;
  std::string svg = open(labels.title, height + 45.0) + drawKey(parts);
  for (double x = 0.0; x <= axis.end * 1.0001; x += axis.step) {
    const double place = kBarLeft + x * units_per_value;
    svg += lineBetween(place, 52, place, height, "grid");
    svg += textAt(place, height + 15, "class=\"faint\" text-anchor=\"middle\"", figureText(x));
  }
  svg += textAt(0.5 * (kBarLeft + kBarRight), height + 37, "text-anchor=\"middle\"", labels.x);
  double y = 60.0;
  for (const BarGroup& group : groups) {
    const double group_height = static_cast<double>(group.bars.size()) * kBarHeight;
    svg += textAt(0, y + 0.5 * group_height + 4, "", shortened(group.name));
    for (const Bar& bar : group.bars) {
      svg += drawBar(bar, group.name, parts, y, units_per_value);
      y += kBarHeight;
    }
    y += kGroupGap;
  }
  return svg + "</svg>\n";
}

}  // namespace ensemble::cli
