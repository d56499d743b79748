// wardrobe.json (interfaces.md, "A wardrobe folder").
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "core/input_error.h"
#include "core/json_limits.h"
#include "core/json_schema.h"
#include "core/nearest_name.h"
#include "core/wardrobe_files.h"
#include "embedded/kWardrobeJsonSchema.h"

namespace ensemble {
namespace {

using OrderedJson = nlohmann::ordered_json;
using nlohmann::json;

constexpr const char* kMakeAgain = "make the wardrobe again with `ensemble tag`";

/// "LINE:COLUMN" of the parser's byte, which counts from 1 and may stand just behind the end.
std::string lineAndColumn(const std::string& text, std::size_t byte) {
  std::size_t line = 1, column = 1;
  for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
    column = text[i] == '\n' ? 1 : column + 1;
    line += text[i] == '\n' ? 1 : 0;
  }
  return std::to_string(line) + ":" + std::to_string(column);
}

/// A float as people would write it: six decimals at most.
double rounded(float value) { return std::round(static_cast<double>(value) * 1e6) / 1e6; }

Visibility parseVisibility(const std::string& name) {
  return name == "full" ? Visibility::kFull : name == "partial" ? Visibility::kPartial : Visibility::kHidden;
}

OrderedJson toJson(const ManifestTemplate& body) {
  OrderedJson regions = OrderedJson::array(), clips = OrderedJson::array();
  for (const ManifestRegion& region : body.regions) {
    regions.push_back({{"name", region.name}, {"faces", region.faces}});
  }
  for (const ManifestClip& clip : body.clips) {
    clips.push_back({{"name", clip.name},
                     {"seconds", rounded(clip.seconds)},
                     {"keys", clip.keys},
                     {"ground_speed", rounded(clip.ground_speed)}});
  }
  return {{"file", body.file},
          {"sha256", body.sha256},
          {"geometry_hash", body.geometry_hash},
          {"faces", body.faces},
          {"vertices", body.vertices},
          {"joints", body.joints},
          {"regions", std::move(regions)},
          {"clips", std::move(clips)}};
}

OrderedJson toJson(const ManifestOutfit& outfit) {
  OrderedJson garments = OrderedJson::array(), regions = OrderedJson::array();
  for (const ManifestGarment& garment : outfit.garments) {
    garments.push_back({{"name", garment.name}, {"faces", garment.faces}});
  }
  for (const ManifestTag& tag : outfit.regions) {
    regions.push_back({{"name", tag.name},
                       {"visibility", toString(tag.visibility)},
                       {"template_faces", tag.template_faces},
                       {"visible_faces", tag.visible_faces}});
  }
  return {{"name", outfit.name},           {"file", outfit.file},   {"sha256", outfit.sha256},
          {"slot", toString(outfit.slot)}, {"layer", outfit.layer}, {"garments", std::move(garments)},
          {"regions", std::move(regions)}};
}

/// Another version is refused by name before the schema complains about its details.
void checkVersion(const json& document, const std::string& file) {
  const auto schema = document.is_object() ? document.find("schema") : document.end();
  if (!document.is_object() || schema == document.end() || !schema->is_string()) {
    throw InputError({file, "/schema", "this is not a wardrobe manifest",
                      std::string("expected \"schema\": \"") + kWardrobeSchema + "\""});
  }
  if (*schema != kWardrobeSchema) {
    throw InputError({file, "/schema",
                      "schema \"" + schema->get<std::string>() + "\" is not \"" + kWardrobeSchema + "\"",
                      "make the wardrobe again with this version's `ensemble tag`"});
  }
}

void checkSchema(const json& document, const std::string& file) {
  const std::optional<SchemaError> error = findSchemaError(document, kWardrobeJsonSchema);
  if (!error) return;
  std::string where;
  for (const std::string& step : error->path) where += "/" + step;
  throw InputError({file, where.empty() ? "/" : where, error->what, kMakeAgain});
}

void checkFileName(const std::string& name, const std::string& file, const std::string& where) {
  const std::filesystem::path path(name);
  bool leaves =
      path.is_absolute() || name.find('\0') != std::string::npos || name.find('\\') != std::string::npos;
  for (const auto& step : path) leaves = leaves || step == "..";
  if (leaves) {
    throw InputError({file, where, "file '" + name + "' is not in the wardrobe's folder", kMakeAgain});
  }
}

template <class List>
void checkDistinctNames(const List& list, const std::string& file, const std::string& where) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (names.insert(list[i].name).second) continue;
    throw InputError({file, where + "/" + std::to_string(i) + "/name",
                      "name '" + list[i].name + "' stands twice", kMakeAgain});
  }
}

ManifestTemplate readTemplate(const json& node) {
  ManifestTemplate body;
  body.file = node["file"];
  body.sha256 = node["sha256"];
  body.geometry_hash = node["geometry_hash"];
  body.faces = node["faces"];
  body.vertices = node["vertices"];
  body.joints = node["joints"];
  for (const json& region : node["regions"]) body.regions.push_back({region["name"], region["faces"]});
  for (const json& clip : node["clips"]) {
    body.clips.push_back({clip["name"], clip["seconds"], clip["keys"], clip["ground_speed"]});
  }
  return body;
}

/// @param where the outfit's place in the file
ManifestOutfit readOutfit(const json& node, const std::string& file, const std::string& where) {
  ManifestOutfit outfit;
  outfit.name = node["name"];
  outfit.file = node["file"];
  outfit.sha256 = node["sha256"];
  const std::string slot = node["slot"];
  const std::optional<Slot> known_slot = parseSlot(slot);
  if (!known_slot) {
    throw InputError(
        {file, where + "/slot", quotedName(slot) + " is no slot: not " + slotNames(), kMakeAgain});
  }
  outfit.slot = *known_slot;
  outfit.layer = node["layer"];
  for (const json& garment : node["garments"]) outfit.garments.push_back({garment["name"], garment["faces"]});
  for (const json& tag : node["regions"]) {
    outfit.regions.push_back(
        {tag["name"], parseVisibility(tag["visibility"]), tag["template_faces"], tag["visible_faces"]});
  }
  return outfit;
}

}  // namespace

std::string writeManifest(const Manifest& manifest) {
  OrderedJson outfits = OrderedJson::array();
  for (const ManifestOutfit& outfit : manifest.outfits) outfits.push_back(toJson(outfit));
  const OrderedJson document = {
      {"schema", kWardrobeSchema}, {"template", toJson(manifest.body)}, {"outfits", std::move(outfits)}};
  return document.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

Manifest parseManifest(const std::string& text, const std::string& file) {
  constexpr std::uint32_t kMaxDepth = 16;
  checkJsonLimits(text, file, {.max_depth = kMaxDepth}, kMakeAgain);
  json document;
  try {
    document = json::parse(text);
  } catch (const json::parse_error& error) {
    throw InputError({file, lineAndColumn(text, error.byte), "the JSON is malformed", kMakeAgain});
  } catch (const json::exception&) {  // out_of_range: 1e999
    throw InputError({file, "", "the JSON has a number that is out of range", kMakeAgain});
  }
  checkVersion(document, file);
  checkSchema(document, file);

  Manifest manifest;
  manifest.body = readTemplate(document["template"]);
  checkFileName(manifest.body.file, file, "/template/file");
  checkDistinctNames(manifest.body.regions, file, "/template/regions");
  checkDistinctNames(manifest.body.clips, file, "/template/clips");
  for (const json& outfit : document["outfits"]) {
    const std::string where = "/outfits/" + std::to_string(manifest.outfits.size());
    manifest.outfits.push_back(readOutfit(outfit, file, where));
    checkFileName(manifest.outfits.back().file, file, where + "/file");
    if (!isValidItemName(manifest.outfits.back().name)) {
      throw InputError({file, where + "/name",
                        "'" + manifest.outfits.back().name + "' can't be an outfit's name", kMakeAgain});
    }
  }
  checkDistinctNames(manifest.outfits, file, "/outfits");
  return manifest;
}

ManifestOutfit manifestEntry(const Item& item, const TemplateBody& body, std::string file,
                             std::string sha256) {
  ManifestOutfit entry{item.name, std::move(file), std::move(sha256), item.slot, item.layer, {}, {}};
  for (const Garment& garment : item.garments) {
    std::uint32_t faces = 0;
    for (const ItemPart& part : garment.parts) faces += static_cast<std::uint32_t>(part.faces.size());
    entry.garments.push_back({garment.name, faces});
  }
  for (std::size_t r = 0; r < body.regions.size(); ++r) {
    const Region& region = body.regions[RegionId(r)];
    const RegionTag& tag = item.tags[RegionId(r)];
    entry.regions.push_back({region.name, tag.visibility, region.face_count, tag.visible_faces});
  }
  return entry;
}

bool isValidItemName(std::string_view name) {
  if (name.empty() || name.size() > 100 || name.front() == '.') return false;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f || c == '/' || c == '\\') return false;
  }
  return true;
}

}  // namespace ensemble
