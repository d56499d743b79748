// The report as JSON, as a table for people, and as CSV.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "assetpipe/report.h"

namespace ensemble {
namespace {

double ratio(std::uint64_t value, std::uint64_t base) {
  return base == 0 ? 0.0 : static_cast<double>(value) / static_cast<double>(base);
}

std::uint64_t at(const std::array<std::uint64_t, 3>& values, Technique technique) {
  return values[static_cast<std::size_t>(technique)];
}

/// "+6.0 %"
std::string change(std::uint64_t value, std::uint64_t base) {
  return fmt::format("{:+.1f} %", (ratio(value, base) - 1) * 100);
}

/// "full", "hidden", or the number of visible faces.
std::string tagText(const RegionTag& tag) {
  return tag.visibility == Visibility::kPartial ? std::to_string(tag.visible_faces)
         : tag.visibility == Visibility::kFull  ? "full"
                                                : "-";
}

/// A field for CSV, quoted where it must be.
std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

using Json = nlohmann::ordered_json;

Json toJson(const StoredParts& parts, bool with_template) {
  Json json = Json::object();
  if (with_template) json["template"] = parts.body;
  json["garments"] = parts.garments;
  json["fitted_body"] = parts.fitted;
  return json;
}

Json numberOrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// "measured" where the wardrobe has that many outfits, else how the figure came about.
const char* kindOf(std::uint64_t outfits, std::size_t measured) {
  return outfits == measured ? "measured" : outfits < measured ? "mean of subsets" : "extrapolated";
}

Json toJson(const Extrapolation& extrapolation, std::size_t measured) {
  Json curve = Json::array();
  const auto point = [](const ExtrapolatedFaces& at) {
    Json json = {{"outfits", at.outfits}};
    for (const Technique technique : kAllTechniques) json[toString(technique)] = at.faces[technique];
    json["tagged_vs_prefitted"] = numberOrNull(at.tagged_vs_prefitted);
    return json;
  };
  for (const ExtrapolatedFaces& at : extrapolation.curve) {
    curve.push_back(point(at));
    curve.back()["kind"] = kindOf(at.outfits, measured);
  }
  Json json = point(extrapolation.curve.back());
  json["measured_outfits"] = measured;
  json["limit_tagged_vs_prefitted"] = numberOrNull(extrapolation.limit);
  json["curve"] = std::move(curve);
  return json;
}

std::string extrapolationText(const Extrapolation& extrapolation) {
  const ExtrapolatedFaces& last = extrapolation.curve.back();
  std::string text = fmt::format("\n{} outfits of average size:", last.outfits);
  for (const Technique technique : kAllTechniques) {
    text += fmt::format(" {} {}", toString(technique), last.faces[technique]);
  }
  text += " faces";
  if (last.tagged_vs_prefitted)
    text += fmt::format("; tagged needs {:.1f} % of prefitted", *last.tagged_vs_prefitted * 100.0);
  if (extrapolation.limit)
    text += fmt::format(", {:.1f} % towards infinitely many", *extrapolation.limit * 100.0);
  return text + "\n";
}

Json toJson(const WardrobeCombinations& combinations) {
  Json items = Json::object();
  for (const Slot slot : kAllSlots) items[toString(slot)] = combinations.items[slot];
  return {{"items", std::move(items)},
          {"count", combinations.count ? Json(*combinations.count) : Json(nullptr)},
          {"stored", combinations.stored ? ensemble::toJson(*combinations.stored) : Json(nullptr)}};
}

/// Nothing for a wardrobe of complete outfits, which are not combined.
std::string combinationsText(const WardrobeCombinations& combinations) {
  std::string items;
  for (const Slot slot : kAllSlots) {
    if (combinations.items[slot] == 0) continue;
    items += fmt::format("{}{} {}", items.empty() ? "" : ", ", combinations.items[slot], toString(slot));
  }
  if (items.find(',') == std::string::npos) return "";
  const std::string count = combinations.count ? std::to_string(*combinations.count) : "2^64 or more";
  return fmt::format("\n{} combinations of {}\n", count, items) +
         (combinations.stored
              ? toTable(*combinations.stored)
              : fmt::format("with more than {} different visible bodies\n", kMostVisibleBodies));
}

/// Faces of the three techniques over all outfits, by what they are for.
TechniqueParts totalFaceParts(const Report& report) {
  TechniqueParts total{{{report.template_faces, 0, 0}, {}, {report.template_faces, 0, 0}}};
  for (const OutfitFaces& outfit : report.outfits) {
    const TechniqueParts parts = outfitFaceParts(outfit);
    for (std::size_t t = 0; t < 3; ++t) {
      total[t].garments += parts[t].garments;
      total[t].fitted += parts[t].fitted;
    }
  }
  return total;
}

/// Rows of the CSV for one thing: its three techniques.
std::string csvRows(const std::string& kind_and_name, const TechniqueParts& faces,
                    const TechniqueParts& bytes, const std::string& end) {
  std::string text;
  for (const Technique technique : kAllTechniques) {
    const StoredParts& f = faces[static_cast<std::size_t>(technique)];
    const StoredParts& b = bytes[static_cast<std::size_t>(technique)];
    text += fmt::format("{},{},{},{},{},{},{},{},{},{}{}", kind_and_name, toString(technique), f.body,
                        f.garments, f.fitted, f.sum(), b.body, b.garments, b.fitted, b.sum(), end);
  }
  return text;
}

}  // namespace

nlohmann::ordered_json toJson(const Report& report) {
  Json outfits = Json::array();
  for (std::size_t i = 0; i < report.outfits.size(); ++i) {
    Json regions = Json::array();
    for (std::size_t r = 0; r < report.region_names.size(); ++r) {
      regions.push_back({{"name", report.region_names[r]},
                         {"visibility", toString(report.tags[i][r].visibility)},
                         {"template_faces", report.region_faces[r]},
                         {"visible_faces", report.tags[i][r].visible_faces}});
    }
    const OutfitFaces& faces = report.outfits[i];
    Json bytes = Json::object();
    for (const Technique technique : kAllTechniques) {
      bytes[toString(technique)] = toJson(report.outfit_bytes[i][static_cast<std::size_t>(technique)], false);
    }
    outfits.push_back({{"name", report.outfit_names[i]},
                       {"garment_faces", faces.garments},
                       {"dedicated_faces", faces.dedicated},
                       {"prefitted_faces", faces.garments + faces.visible_body},
                       {"visible_body_faces", faces.visible_body},
                       {"bytes", std::move(bytes)},
                       {"regions", std::move(regions)}});
  }
  const TechniqueParts face_parts = totalFaceParts(report);
  Json techniques = Json::object();
  for (const Technique technique : kAllTechniques) {
    const std::uint64_t faces = report.faces[technique], bytes = at(report.bytes, technique);
    techniques[toString(technique)] = {
        {"faces", faces},
        {"bytes", bytes},
        {"faces_vs_naive", ratio(faces, report.faces[Technique::kNaive])},
        {"bytes_vs_naive", ratio(bytes, at(report.bytes, Technique::kNaive))},
        {"faces_of", toJson(face_parts[static_cast<std::size_t>(technique)], true)},
        {"bytes_of", toJson(report.byte_parts[static_cast<std::size_t>(technique)], true)}};
  }
  Json figures = {{"schema", "ensemble.report/1"},
                  {"template_faces", report.template_faces},
                  {"outfits", std::move(outfits)},
                  {"techniques", std::move(techniques)},
                  {"lower_bound_bytes", report.lower_bound_bytes}};
  figures["combinations"] = toJson(report.combinations);
  if (report.extrapolation) figures["extrapolated"] = toJson(*report.extrapolation, report.outfits.size());
  return figures;
}

std::string toTable(const Report& report) {
  std::size_t name_width = 8;
  for (const std::string& name : report.outfit_names) name_width = std::max(name_width, name.size());
  std::string text = fmt::format("{:<{}} {:>8}", "outfit", name_width, "garments");
  for (const std::string& region : report.region_names) text += fmt::format(" {:>8.8}", region);
  text += fmt::format(" {:>10} {:>10}\n", "dedicated", "prefitted");
  for (std::size_t i = 0; i < report.outfits.size(); ++i) {
    const OutfitFaces& faces = report.outfits[i];
    text += fmt::format("{:<{}} {:>8}", report.outfit_names[i], name_width, faces.garments);
    for (const RegionTag& tag : report.tags[i]) text += fmt::format(" {:>8}", tagText(tag));
    text += fmt::format(" {:>10} {:>10}\n", faces.dedicated, faces.garments + faces.visible_body);
  }
  text += fmt::format("{:<{}} {:>8}", "template", name_width, "");
  for (const std::uint64_t faces : report.region_faces) text += fmt::format(" {:>8}", faces);
  text += fmt::format("\n\n{:<12} {:>10} {:>10} {:>14} {:>10}\n", "technique", "faces", "vs naive",
                      "mesh bytes", "vs naive");
  for (const Technique technique : kAllTechniques) {
    text += fmt::format("{:<12} {:>10} {:>10} {:>14} {:>10}\n", toString(technique), report.faces[technique],
                        change(report.faces[technique], report.faces[Technique::kNaive]),
                        at(report.bytes, technique),
                        change(at(report.bytes, technique), at(report.bytes, Technique::kNaive)));
  }
  text += fmt::format("{:<12} {:>10} {:>10} {:>14}\n", "lower bound", "", "", report.lower_bound_bytes);
  if (report.extrapolation) text += extrapolationText(*report.extrapolation);
  return text + combinationsText(report.combinations);
}

nlohmann::ordered_json toJson(const CombinationStorage& stored) {
  return {{"visible_bodies", stored.visible_bodies},
          {"dedicated_sub_meshes", stored.dedicated_sub_meshes},
          {"lower_bound_bytes", stored.lower_bound_bytes},
          {"tagged_bytes", stored.tagged_bytes},
          {"prefitted_bytes", stored.prefitted_bytes},
          {"tagged_vs_lower_bound", ratio(stored.tagged_bytes, stored.lower_bound_bytes)},
          {"prefitted_vs_tagged", ratio(stored.prefitted_bytes, stored.tagged_bytes)}};
}

std::string toTable(const CombinationStorage& stored) {
  std::string text = fmt::format("{} different visible bodies, {} dedicated sub-meshes\n",
                                 stored.visible_bodies, stored.dedicated_sub_meshes);
  const auto row = [&](const char* name, std::uint64_t bytes) {
    text += fmt::format("{:<24} {:>14} {:>8.3f} x\n", name, bytes, ratio(bytes, stored.lower_bound_bytes));
  };
  text += fmt::format("{:<24} {:>14}\n", "stored", "mesh bytes");
  row("template and items once", stored.lower_bound_bytes);
  row("tagged", stored.tagged_bytes);
  row("prefitted", stored.prefitted_bytes);
  return text;
}

std::string toCsv(const Report& report) {
  std::string text =
      "kind,name,technique,template_faces,garment_faces,fitted_body_faces,faces,template_bytes,"
      "garment_bytes,fitted_body_bytes,bytes";
  for (const std::string& region : report.region_names) text += "," + csvField("visible." + region);
  text += "\n";
  const std::string no_regions = std::string(report.region_names.size(), ',') + "\n";
  for (std::size_t i = 0; i < report.outfits.size(); ++i) {
    std::string visible;
    for (const RegionTag& tag : report.tags[i]) visible += "," + std::to_string(tag.visible_faces);
    text += csvRows("outfit," + csvField(report.outfit_names[i]), outfitFaceParts(report.outfits[i]),
                    report.outfit_bytes[i], visible + "\n");
  }
  text += csvRows("total,", totalFaceParts(report), report.byte_parts, no_regions);
  text += fmt::format("lower bound,,,,,,,,,,{}{}", report.lower_bound_bytes, no_regions);
  if (!report.extrapolation) return text;
  for (const ExtrapolatedFaces& at : report.extrapolation->curve) {
    for (const Technique technique : kAllTechniques) {
      text += fmt::format("{},{},{},,,,{},,,,{}", kindOf(at.outfits, report.outfits.size()), at.outfits,
                          toString(technique), at.faces[technique], no_regions);
    }
  }
  return text;
}

}  // namespace ensemble
