#include "assetpipe/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

StoredFaces countStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits) {
  StoredFaces faces{{template_faces, 0, template_faces}};
  for (const OutfitFaces& outfit : outfits) {
    faces.of[static_cast<std::size_t>(Technique::kNaive)] += outfit.garments;
    faces.of[static_cast<std::size_t>(Technique::kPrefitted)] += outfit.garments + outfit.visible_body;
    faces.of[static_cast<std::size_t>(Technique::kTagged)] += outfit.garments + outfit.dedicated;
  }
  return faces;
}

StoredFaces extrapolateStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits,
                                   std::uint64_t outfit_count) {
  StoredFaces result{{template_faces, 0, template_faces}};
  if (outfits.empty()) return result;
  const StoredFaces known = countStoredFaces(0, outfits);
  for (std::size_t t = 0; t < 3; ++t) {
    result.of[t] += (known.of[t] * outfit_count + outfits.size() / 2) / outfits.size();
  }
  return result;
}

Report makeReport(const Wardrobe& wardrobe) {
  Report report;
  report.template_faces = wardrobe.body.faces.size();
  for (const Region& region : wardrobe.body.regions) {
    report.region_names.push_back(region.name);
    report.region_faces.push_back(region.face_count);
  }
  std::vector<Combination> combinations;
  for (std::size_t i = 0; i < wardrobe.items.size(); ++i) {
    const Item& item = wardrobe.items[ItemId(i)];
    report.outfit_names.push_back(item.name);
    report.outfits.push_back(
        {item.garmentFaceCount(), item.visibleBodyFaceCount(), item.dedicatedFaceCount()});
    report.tags.push_back(item.tags.raw());
    combinations.push_back({ItemId(i)});
  }
  report.faces = countStoredFaces(report.template_faces, report.outfits);
  for (const Technique technique : kAllTechniques) {
    report.bytes[static_cast<std::size_t>(technique)] =
        buildSubMeshLists(wardrobe, combinations, technique).meshBytes();
  }
  report.lower_bound_bytes = lowerBoundBytes(wardrobe, combinations);
  return report;
}

nlohmann::ordered_json toJson(const Report& report) {
  using Json = nlohmann::ordered_json;
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
    outfits.push_back({{"name", report.outfit_names[i]},
                       {"garment_faces", faces.garments},
                       {"dedicated_faces", faces.dedicated},
                       {"prefitted_faces", faces.garments + faces.visible_body},
                       {"regions", std::move(regions)}});
  }
  Json techniques = Json::object();
  for (const Technique technique : kAllTechniques) {
    const std::uint64_t faces = report.faces[technique], bytes = at(report.bytes, technique);
    techniques[toString(technique)] = {{"faces", faces},
                                       {"bytes", bytes},
                                       {"faces_vs_naive", ratio(faces, report.faces[Technique::kNaive])},
                                       {"bytes_vs_naive", ratio(bytes, at(report.bytes, Technique::kNaive))}};
  }
  return {{"schema", "ensemble.report/1"},
          {"template_faces", report.template_faces},
          {"outfits", std::move(outfits)},
          {"techniques", std::move(techniques)},
          {"lower_bound_bytes", report.lower_bound_bytes}};
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
  return text;
}

std::string toCsv(const Report& report) {
  std::string text = "outfit,garment_faces,visible_body_faces,dedicated_faces,prefitted_faces";
  for (const std::string& region : report.region_names) text += "," + csvField(region);
  text += "\n";
  for (std::size_t i = 0; i < report.outfits.size(); ++i) {
    const OutfitFaces& faces = report.outfits[i];
    text += fmt::format("{},{},{},{},{}", csvField(report.outfit_names[i]), faces.garments,
                        faces.visible_body, faces.dedicated, faces.garments + faces.visible_body);
    for (const RegionTag& tag : report.tags[i]) text += "," + std::to_string(tag.visible_faces);
    text += "\n";
  }
  text += "technique,faces,bytes\n";
  for (const Technique technique : kAllTechniques) {
    text +=
        fmt::format("{},{},{}\n", toString(technique), report.faces[technique], at(report.bytes, technique));
  }
  return text;
}

}  // namespace ensemble
