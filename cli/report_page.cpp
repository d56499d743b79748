#include "cli/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/html_page.h"
#include "cli/svg_plot.h"

namespace ensemble::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTechniques[] = {"naive", "prefitted", "tagged"};
const std::vector<BarPart> kOutfitParts = {{"garments", "garments"}, {"body made for the outfit", "fitted"}};
const std::vector<BarPart> kTotalParts = {
    {"template", "template"}, {"garments", "garments"}, {"body made for outfits", "fitted"}};

std::string countText(const Json& value) { return groupDigits(value.get<std::uint64_t>()); }

std::string percentText(const Json& share) {
  return share.is_null() ? "-" : fmt::format("{:.1f} %", share.get<double>() * 100.0);
}

/// Bytes in the unit that keeps numbers short.
struct ByteUnit {
  double bytes = 1000.0;
  const char* name = "kB (1,000 bytes)";
};
ByteUnit byteUnit(const Json& figures) {
  std::uint64_t greatest = 0;
  for (const char* technique : kTechniques) {
    greatest = std::max(greatest, figures["techniques"][technique]["bytes"].get<std::uint64_t>());
  }
  return greatest > 10'000'000 ? ByteUnit{1e6, "MB (1,000,000 bytes)"} : ByteUnit{};
}

/// The body faces that a technique makes for one outfit.
std::uint64_t fittedFaces(const Json& outfit, const std::string& technique) {
  if (technique == "naive") return 0;
  return outfit[technique == "tagged" ? "dedicated_faces" : "visible_body_faces"].get<std::uint64_t>();
}

std::vector<BarGroup> faceBars(const Json& figures) {
  std::vector<BarGroup> groups;
  for (const Json& outfit : figures["outfits"]) {
    BarGroup& group = groups.emplace_back(BarGroup{outfit["name"].get<std::string>(), {}});
    for (const char* technique : kTechniques) {
      group.bars.push_back(
          {technique,
           {outfit["garment_faces"].get<double>(), static_cast<double>(fittedFaces(outfit, technique))}});
    }
  }
  return groups;
}

std::vector<BarGroup> byteBars(const Json& figures, double unit) {
  std::vector<BarGroup> groups;
  for (const Json& outfit : figures["outfits"]) {
    BarGroup& group = groups.emplace_back(BarGroup{outfit["name"].get<std::string>(), {}});
    for (const char* technique : kTechniques) {
      const Json& bytes = outfit["bytes"][technique];
      group.bars.push_back(
          {technique, {bytes["garments"].get<double>() / unit, bytes["fitted_body"].get<double>() / unit}});
    }
  }
  return groups;
}

std::vector<BarGroup> totalBars(const Json& figures, const char* key, double unit) {
  BarGroup group{"all outfits", {}};
  for (const char* technique : kTechniques) {
    const Json& parts = figures["techniques"][technique][key];
    group.bars.push_back({technique,
                          {parts["template"].get<double>() / unit, parts["garments"].get<double>() / unit,
                           parts["fitted_body"].get<double>() / unit}});
  }
  return {group};
}

void addTotals(HtmlPage& page, const Json& figures, const ByteUnit& unit) {
  page.addHeading("In all");
  page.addFigure(
      barPlot({"Faces stored for all outfits", "faces", ""}, kTotalParts,
              totalBars(figures, "faces_of", 1.0)),
      "Naive: the template and the garments; hidden skin is drawn. Pre-fitted: garments and a body "
      "cut to size for every outfit, no template. Tagged: the template, the garments, and dedicated "
      "sub-meshes for regions that show in part.");
  page.addFigure(
      barPlot({"Mesh bytes on the GPU for all outfits", unit.name, ""}, kTotalParts,
              totalBars(figures, "bytes_of", unit.bytes)),
      fmt::format(
          "Vertices and indices, each distinct mesh once. Template and distinct garments alone, which "
          "no technique can do without, take {} bytes. A dedicated sub-mesh is a list of indices into "
          "the template's vertices; a pre-fitted body has vertices of its own.",
          countText(figures["lower_bound_bytes"])));
  std::vector<std::vector<std::string>> rows;
  for (const char* technique : kTechniques) {
    const Json& row = figures["techniques"][technique];
    rows.push_back({technique, countText(row["faces"]), percentText(row["faces_vs_naive"]),
                    countText(row["bytes"]), percentText(row["bytes_vs_naive"])});
  }
  rows.push_back({"lower bound", "", "", countText(figures["lower_bound_bytes"]), ""});
  page.addTable("Faces and bytes in all", {"technique", "faces", "of naive", "mesh bytes", "of naive"}, rows);
}

void addOutfits(HtmlPage& page, const Json& figures, const ByteUnit& unit) {
  page.addHeading("Outfit by outfit");
  page.addFigure(barPlot({"Faces stored for each outfit", "faces", ""}, kOutfitParts, faceBars(figures)),
                 fmt::format("Without the template of {} faces, which naive and tagged store once.",
                             countText(figures["template_faces"])));
  page.addFigure(
      barPlot({"Mesh bytes of each outfit", unit.name, ""}, kOutfitParts, byteBars(figures, unit.bytes)),
      "Without the template. What several outfits share counts at each of them here, and once in the "
      "totals above.");
  std::vector<std::vector<std::string>> rows, bytes;
  for (const Json& outfit : figures["outfits"]) {
    const std::string name = outfit["name"];
    rows.push_back(
        {name, countText(outfit["garment_faces"]), countText(outfit["visible_body_faces"]),
         countText(outfit["prefitted_faces"]), countText(outfit["dedicated_faces"]),
         groupDigits(outfit["garment_faces"].get<std::uint64_t>() + fittedFaces(outfit, "tagged"))});
    bytes.push_back({name, countText(outfit["bytes"]["naive"]["garments"]),
                     countText(outfit["bytes"]["prefitted"]["fitted_body"]),
                     countText(outfit["bytes"]["tagged"]["fitted_body"])});
  }
  page.addTable("Faces of each outfit",
                {"outfit", "garments", "visible body", "pre-fitted", "dedicated", "tagged"}, rows);
  page.addTable("Mesh bytes of each outfit",
                {"outfit", "garments", "pre-fitted body", "dedicated sub-meshes"}, bytes);
}

void addRegions(HtmlPage& page, const Json& figures) {
  if (figures["outfits"].empty()) return;
  std::vector<std::string> header = {"outfit"};
  for (const Json& region : figures["outfits"][0]["regions"]) {
    header.push_back(
        fmt::format("{} ({})", region["name"].get<std::string>(), countText(region["template_faces"])));
  }
  std::vector<std::vector<std::string>> rows;
  for (const Json& outfit : figures["outfits"]) {
    std::vector<std::string>& row = rows.emplace_back(std::vector{outfit["name"].get<std::string>()});
    for (const Json& region : outfit["regions"]) {
      const std::string visibility = region["visibility"];
      row.push_back(visibility == "partial" ? countText(region["visible_faces"]) : visibility);
    }
  }
  page.addHeading("What shows of each region");
  page.addTable("The template's faces in brackets; a number is that of the visible faces of a partial region",
                header, rows);
}

/// A curve of figure 6, dashed where it is not of the wardrobe's own outfits.
PlotSeries curveOf(const Json& extrapolated, const char* key, const char* color, double scale) {
  const auto measured = extrapolated["measured_outfits"].get<double>();
  PlotSeries series{color, color, {}, measured};
  for (const Json& point : extrapolated["curve"]) {
    if (point[key].is_null()) continue;
    series.points.push_back({.x = point["outfits"].get<double>(),
                             .y = point[key].get<double>() * scale,
                             .marked = point["kind"] == "measured"});
  }
  return series;
}

void addExtrapolation(HtmlPage& page, const Json& extrapolated) {
  const std::string measured = countText(extrapolated["measured_outfits"]);
  page.addHeading("With more outfits");
  page.addParagraph(fmt::format(
      "This is figure 6 of Lister, Laycock and Day: storage for more outfits than there are, if those to "
      "come "
      "were like the mean of these. Only the figures at {0} outfits, marked in the plots, are counted. To "
      "the "
      "left stand means over all choices of fewer outfits from the {0}; the dashed lines to the right are "
      "extrapolated.",
      measured));
  std::vector<PlotSeries> faces;
  for (const char* technique : kTechniques) faces.push_back(curveOf(extrapolated, technique, technique, 1.0));
  page.addFigure(linePlot({"Faces stored, by number of outfits", "outfits", "faces"}, faces),
                 fmt::format("Counted at {} outfits, extrapolated beyond.", measured));
  const Json& limit = extrapolated["limit_tagged_vs_prefitted"];
  if (!limit.is_null()) {
    PlotSeries share = curveOf(extrapolated, "tagged_vs_prefitted", "tagged", 100.0);
    share.name = "tagged";
    page.addFigure(linePlot({"Faces of tagged in relation to pre-fitted", "outfits", "% of pre-fitted"},
                            std::span(&share, 1),
                            ReferenceLine{limit.get<double>() * 100.0,
                                          "towards infinitely many outfits: " + percentText(limit)}),
                   "Below 100 % tagged stores less than pre-fitted.");
  }
  std::vector<std::vector<std::string>> rows;
  for (const Json& point : extrapolated["curve"]) {
    rows.push_back({countText(point["outfits"]), countText(point["naive"]), countText(point["prefitted"]),
                    countText(point["tagged"]), percentText(point["tagged_vs_prefitted"]),
                    point["kind"].get<std::string>()});
  }
  page.addTable("Faces by number of outfits",
                {"outfits", "naive", "pre-fitted", "tagged", "tagged of pre-fitted", "figure"}, rows);
}

/// What combinations store, as a plot and in words.
void addStored(HtmlPage& page, const Json& stored) {
  const auto bytes = [&](const char* key) { return stored[key].get<double>(); };
  const ByteUnit unit = bytes("prefitted_bytes") > 1e7 ? ByteUnit{1e6, "MB (1,000,000 bytes)"} : ByteUnit{};
  const std::vector<BarPart> parts = {{"mesh bytes", "garments"}};
  BarGroup group{"all combinations", {}};
  for (const auto& [name, key] :
       {std::pair("items once", "lower_bound_bytes"), std::pair("tagged", "tagged_bytes"),
        std::pair("prefitted", "prefitted_bytes")})
    group.bars.push_back({name, {bytes(key) / unit.bytes}});
  page.addFigure(
      barPlot({"Mesh bytes of all combinations", unit.name, ""}, parts, std::span(&group, 1)),
      fmt::format(
          "Items once: the template and each item. Tagged: and an index list for each region that shows in "
          "part, once for all bodies that show it alike; {:.3f} times the items once. Pre-fitted: each item "
          "once, and a copy of each visible body; {:.2f} times as much as tagged.",
          stored["tagged_vs_lower_bound"].get<double>(), stored["prefitted_vs_tagged"].get<double>()));
}

std::vector<std::string> storedRow(const std::string& name, const std::string& combinations,
                                   const Json& stored) {
  return {name,
          combinations,
          countText(stored["visible_bodies"]),
          countText(stored["dedicated_sub_meshes"]),
          countText(stored["lower_bound_bytes"]),
          countText(stored["tagged_bytes"]),
          countText(stored["prefitted_bytes"])};
}
const std::vector<std::string> kStoredHeader = {"",           "combinations", "visible bodies", "sub-meshes",
                                                "items once", "tagged",       "pre-fitted"};

/// Nothing for a wardrobe of complete outfits, which are not combined.
void addCombinations(HtmlPage& page, const Json& figures) {
  const Json& combinations = figures["combinations"];
  std::string items;
  std::size_t slots = 0;
  for (const auto& [slot, count] : combinations["items"].items()) {
    if (count == 0) continue;
    items += fmt::format("{}{} {}", slots++ == 0 ? "" : ", ", countText(count), slot);
  }
  if (slots < 2) return;
  page.addHeading("Combined");
  const Json& number = combinations["count"];
  const std::string count = number.is_null() ? "2^64 or more" : countText(number);
  page.addParagraph(fmt::format("{} combinations of the items ({}) dress a person.", count, items));
  const Json& stored = combinations["stored"];
  if (stored.is_null()) {
    page.addParagraph("They show too many different bodies to count what all of them store.");
    return;
  }
  addStored(page, stored);
  page.addTable("What all combinations store, in bytes", kStoredHeader,
                {storedRow(figures["wardrobe"], count, stored)});
}

/// What items hide of one another.
void addLayers(HtmlPage& page, const Json& layers) {
  if (layers["pairs"].get<std::uint64_t>() == 0) return;
  page.addHeading("Worn over one another");
  page.addTable("The garments' faces, each combination's once",
                {"pairs of items", "faces", "hidden", "drawn", "index lists"},
                {{countText(layers["pairs"]), countText(layers["garment_faces"]),
                  countText(layers["hidden_garment_faces"]), countText(layers["drawn_garment_faces"]),
                  countText(layers["garment_lists"])}});
}

}  // namespace

std::string sceneReportPage(const Json& figures) {
  HtmlPage page("What a crowd's clothes store: " + figures["scene"].get<std::string>());
  page.addParagraph(
      fmt::format("{} people in {} combinations of items. Mesh bytes as the GPU holds them, each "
                  "distinct mesh once.",
                  countText(figures["people"]), countText(figures["combinations"])));
  addStored(page, figures["stored"]);
  std::vector<std::vector<std::string>> rows;
  for (const Json& wardrobe : figures["wardrobes"]) {
    const std::string key = wardrobe["key"];
    rows.push_back(
        storedRow(fmt::format("{}{}{} people", key, key.empty() ? "" : ", ", countText(wardrobe["people"])),
                  countText(wardrobe["combinations"]), wardrobe["stored"]));
  }
  if (rows.size() > 1)
    rows.push_back(storedRow("in all", countText(figures["combinations"]), figures["stored"]));
  page.addTable("What the combinations that people wear store, in bytes", kStoredHeader, rows);
  addLayers(page, figures["layers"]);
  return page.text();
}

std::string reportPage(const Json& figures) {
  HtmlPage page("What tagging saves: " + figures["wardrobe"].get<std::string>());
  page.addParagraph(fmt::format(
      "One template of {} faces in {} outfits, stored by three techniques. The figures are of the "
      "lists that the renderer draws.",
      countText(figures["template_faces"]), figures["outfits"].size()));
  const ByteUnit unit = byteUnit(figures);
  addTotals(page, figures, unit);
  addOutfits(page, figures, unit);
  addRegions(page, figures);
  addCombinations(page, figures);
  if (figures.contains("extrapolated")) addExtrapolation(page, figures["extrapolated"]);
  return page.text();
}

}  // namespace ensemble::cli
