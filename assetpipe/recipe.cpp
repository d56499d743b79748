// A recipe's file: strict YAML, documented in docs/authoring.md.
#include "assetpipe/recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <string_view>

#include "assetpipe/author_body.h"
#include "assetpipe/recipe_schema.h"
#include "core/atomic_file.h"
#include "core/nearest_name.h"
#include "core/yaml_reader.h"

namespace ensemble {
namespace {

constexpr float kMm = 0.001f;

std::string oneOf(const YamlValue& value, std::initializer_list<std::string_view> words) {
  return std::string(*(words.begin() + value.word(words)));
}

/// Millimetres in the file, metres here.
float length(const YamlValue& value, double min, double max, bool is_open_min = false) {
  return kMm * value.numberFloat({.min = min, .max = max, .is_open_min = is_open_min, .unit = "millimetres"});
}

float lengthOr(const YamlValue& map, const char* key, float otherwise, double min, double max) {
  const auto value = map.find(key);
  return value ? length(*value, min, max) : otherwise;
}

float numberOr(const YamlValue& map, const char* key, float otherwise, double min, double max) {
  const auto value = map.find(key);
  return value ? value->numberFloat({.min = min, .max = max}) : otherwise;
}

Vec3 readColor(const YamlValue& value) {
  const std::string text = value.text("a colour");
  std::uint32_t rgb = 0;
  const char* const begin = text.data() + 1;
  const bool fits =
      text.size() == 7 && text[0] == '#' && std::from_chars(begin, begin + 6, rgb, 16).ptr == begin + 6;
  if (!fits) value.fail(value.description() + ", which is no colour", "write it as \"#rrggbb\", in quotes");
  return Vec3((rgb >> 16) & 255u, (rgb >> 8) & 255u, rgb & 255u) / 255.0f;
}

Interval readInterval(const YamlValue& value, double min, double max, float unit = 1.0f) {
  const std::vector<YamlValue> ends = value.items("a pair [from, to]");
  if (ends.size() != 2)
    value.fail(value.path() + " has " + std::to_string(ends.size()) + " numbers", "give [from, to]");
  const NumberRange range{.min = min, .max = max};
  const Interval interval{unit * ends[0].numberFloat(range), unit * ends[1].numberFloat(range)};
  if (!(interval.from < interval.to)) {
    value.fail(fmt::format("{} runs from {:g} to {:g}, which is empty", value.path(), interval.from / unit,
                           interval.to / unit),
               "give the lower end first");
  }
  return interval;
}

/// A length, or [[place, length], ...] with places ascending.
Profile readProfile(const YamlValue& value, double min, double max) {
  if (!value.isSequence()) return {{{0.0f, length(value, min, max)}}};
  Profile profile;
  for (const YamlValue& item : value.items("a list of [place, millimetres]")) {
    const std::vector<YamlValue> pair = item.items("a pair [place, millimetres]");
    if (pair.size() != 2) item.fail(item.path() + " is no pair", "give [place, millimetres]");
    const float place = pair[0].numberFloat({.min = -3.0, .max = 3.0});
    if (!profile.points.empty() && !(profile.points.back().first < place)) {
      pair[0].fail(pair[0].description() + ", which is not above the place before it",
                   "give places ascending");
    }
    profile.points.emplace_back(place, length(pair[1], min, max));
  }
  if (profile.points.empty())
    value.fail(value.path() + " is empty", "give a length or [[place, millimetres], ...]");
  return profile;
}

Pattern readPattern(const YamlValue& value) {
  value.expectKeys({"kind", "color", "size"});
  Pattern pattern;
  const auto kind = value.find("kind");
  const auto color = value.find("color");
  if (!kind || !color) value.fail(value.path() + " has no " + (kind ? "color" : "kind"), "add it");
  pattern.kind =
      static_cast<PatternKind>(1 + kind->word({"stripes", "pinstripes", "checks", "dots", "knit"}));
  pattern.color = readColor(*color);
  pattern.size = lengthOr(value, "size", pattern.size, 5.0, 1000.0);
  return pattern;
}

Vec3 readPlace(const YamlValue& value) {
  return kMm * value.vector({.min = -1000.0, .max = 1000.0, .unit = "millimetres"});
}

SolidRecipe readSolid(const YamlValue& value) {
  value.expectKeys(
      {"shape", "frame", "center", "radii", "tilt", "from", "to", "ends", "both_sides", "blend"});
  SolidRecipe solid;
  const auto shape = value.find("shape");
  if (!shape) value.fail(value.path() + " has no shape", "add shape: ellipsoid, cone or disc");
  solid.shape = static_cast<SolidRecipe::Shape>(shape->word({"ellipsoid", "cone", "disc"}));
  if (const auto frame = value.find("frame")) {
    solid.frame = static_cast<SolidRecipe::Frame>(frame->word({"head", "neck", "foot"}));
  }
  const bool is_cone = solid.shape == SolidRecipe::Shape::kCone;
  for (const char* key : {is_cone ? "from" : "center", is_cone ? "to" : "radii"}) {
    if (!value.find(key))
      value.fail(value.path() + " has no " + key, "add " + std::string(key) + ": [x, y, z]");
  }
  if (is_cone) {
    solid.from = readPlace(*value.find("from"));
    solid.to = readPlace(*value.find("to"));
    const auto ends = value.find("ends");
    const std::vector<YamlValue> radii = ends ? ends->items("two radii") : std::vector<YamlValue>();
    if (radii.size() != 2)
      value.fail(value.path() + " has no two radii", "add ends: [millimetres, millimetres]");
    solid.ends = {length(radii[0], 1.0, 500.0), length(radii[1], 1.0, 500.0)};
    if (!(glm::distance(solid.from, solid.to) > std::abs(solid.ends[0] - solid.ends[1]))) {
      value.fail(value.path() + " has one end inside the other", "move its ends apart, or use an ellipsoid");
    }
  } else {
    solid.center = readPlace(*value.find("center"));
    solid.radii = kMm * value.find("radii")->vector({.min = 1.0, .max = 1000.0, .unit = "millimetres"});
  }
  solid.tilt_degrees = numberOr(value, "tilt", 0.0f, -180.0, 180.0);
  if (const auto both = value.find("both_sides")) solid.both_sides = both->boolean();
  solid.blend = lengthOr(value, "blend", solid.blend, 0.0, 100.0);
  return solid;
}

std::string readName(const YamlValue& value) {
  std::string name = value.text("a name");
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.size() > 64 || name.find_first_not_of(kAllowed) != std::string::npos) {
    value.fail(value.description() + ", which can't be a name", "use up to 64 letters, digits, '-' and '_'");
  }
  return name;
}

std::string readMaterial(const YamlValue& value) { return oneOf(value, {"cloth", "hair", "shoes", "fixed"}); }

TrimRecipe readTrim(const YamlValue& value) {
  value.expectKeys(
      {"name", "material", "of", "width", "level", "arm", "across", "side", "slant", "raise", "color"});
  TrimRecipe trim;
  trim.mark = value.mark();
  const auto name = value.find("name");
  const auto color = value.find("color");
  if (!name || !color) value.fail(value.path() + " has no " + (name ? "color" : "name"), "add it");
  trim.name = readName(*name);
  trim.color = readColor(*color);
  if (const auto material = value.find("material")) trim.material = readMaterial(*material);
  if (const auto of = value.find("of"))
    trim.of = oneOf(*of, {"hem", "top", "neck", "sleeves", "front", "edge", "sole"});
  trim.width = lengthOr(value, "width", trim.width, 1.0, 500.0);
  if (const auto level = value.find("level")) trim.level = readInterval(*level, -3.0, 2.0);
  if (const auto arm = value.find("arm")) trim.arm = readInterval(*arm, 0.0, 3.0);
  if (const auto across = value.find("across")) trim.across = readInterval(*across, -500.0, 500.0, kMm);
  if (const auto side = value.find("side")) trim.side = oneOf(*side, {"front", "back", "outside"});
  if (trim.of.empty() && !trim.level && !trim.arm && !trim.across && trim.side != "outside") {
    value.fail(value.path() + " has no place", "add of, level, arm or across");
  }
  trim.slant = numberOr(value, "slant", 0.0f, -3.0, 3.0);
  trim.raise = lengthOr(value, "raise", 0.0f, -10.0, 20.0);
  return trim;
}

NeckRecipe readNeck(const YamlValue& value) {
  value.expectKeys({"rise", "width", "drop", "vee"});
  NeckRecipe neck;
  neck.rise = lengthOr(value, "rise", neck.rise, -100.0, 150.0);
  neck.width = lengthOr(value, "width", neck.width, 30.0, 250.0);
  neck.drop = lengthOr(value, "drop", neck.drop, 0.0, 300.0);
  neck.vee = lengthOr(value, "vee", neck.vee, 0.0, 400.0);
  return neck;
}

DrapeRecipe readDrape(const YamlValue& value) {
  value.expectKeys({"from", "ease", "cling", "flare", "folds", "fold_count"});
  DrapeRecipe drape;
  drape.from = numberOr(value, "from", drape.from, -2.5, 1.0);
  drape.ease = lengthOr(value, "ease", drape.ease, 1.0, 200.0);
  drape.cling = numberOr(value, "cling", drape.cling, 0.0, 5.0);
  drape.flare = numberOr(value, "flare", drape.flare, 0.0, 2.0);
  drape.folds = lengthOr(value, "folds", drape.folds, 0.0, 60.0);
  if (const auto count = value.find("fold_count")) {
    drape.fold_count = static_cast<std::uint32_t>(count->wholeNumber(2, 40));
  }
  return drape;
}

FrontRecipe readFront(const YamlValue& value) {
  value.expectKeys({"level", "width"});
  const auto level = value.find("level");
  if (!level) value.fail(value.path() + " has no level", "add level: [from, to]");
  FrontRecipe front;
  front.level = readInterval(*level, -3.0, 2.0);
  if (const auto width = value.find("width")) {
    const std::vector<YamlValue> ends = width->items("a pair [below, above]");
    if (ends.size() != 2) width->fail(width->path() + " is no pair", "give [below, above], in millimetres");
    front.width = {0.5f * length(ends[0], 0.0, 500.0), 0.5f * length(ends[1], 0.0, 500.0)};
  }
  return front;
}

SoleRecipe readSole(const YamlValue& value) {
  value.expectKeys({"thickness", "rise", "out", "heel"});
  SoleRecipe sole;
  if (const auto thickness = value.find("thickness")) sole.thickness = length(*thickness, 0.0, 60.0, true);
  sole.rise = lengthOr(value, "rise", sole.rise, 1.0, 50.0);
  sole.out = lengthOr(value, "out", sole.out, 0.0, 40.0);
  sole.heel = lengthOr(value, "heel", sole.heel, 0.0, 60.0);
  return sole;
}

HairRecipe readHair(const YamlValue& value) {
  value.expectKeys({"front", "sideburn", "nape", "curtain"});
  HairRecipe hair;
  hair.front = lengthOr(value, "front", hair.front, -100.0, 120.0);
  hair.sideburn = lengthOr(value, "sideburn", hair.sideburn, -150.0, 60.0);
  hair.nape = lengthOr(value, "nape", hair.nape, -300.0, 60.0);
  if (const auto curtain = value.find("curtain")) {
    hair.curtain = true;
    hair.length = length(*curtain, 20.0, 600.0);
  }
  return hair;
}

void readBodyKeys(const YamlValue& value, GarmentRecipe& garment) {
  const auto hem = value.find("hem");
  if (!hem) value.fail(value.path() + " has no hem", "add hem: LEVEL, for example -0.1");
  garment.hem = hem->numberFloat({.min = -2.9, .max = 0.9});
  garment.hem_rise = lengthOr(value, "hem_rise", 0.0f, -300.0, 300.0);
  if (const auto top = value.find("top")) garment.top = top->numberFloat({.min = -2.0, .max = 1.0});
  if (const auto neck = value.find("neck")) garment.neck = readNeck(*neck);
  if (garment.top.has_value() == garment.neck.has_value()) {
    value.fail(value.path() + (garment.top ? " has both top and neck" : " has neither top nor neck"),
               "give top: LEVEL for what ends below the shoulders, neck: {...} for what goes over them");
  }
  if (garment.top && !(garment.hem < *garment.top)) {
    hem->fail(hem->description() + ", which is not below its top", "give a hem below the top");
  }
  if (const auto sleeves = value.find("sleeves")) {
    garment.sleeves = Interval{0.0f, sleeves->numberFloat({.min = 0.05, .max = 2.3})};
  }
  if (const auto ease = value.find("sleeve_ease")) garment.sleeve_ease = readProfile(*ease, 1.0, 120.0);
  if (const auto ease = value.find("leg_ease")) garment.leg_ease = readProfile(*ease, 1.0, 120.0);
  if (const auto armhole = value.find("armhole")) garment.armhole = length(*armhole, -60.0, 120.0);
  if (garment.armhole && garment.sleeves) {
    value.fail(value.path() + " has both sleeves and an armhole", "leave one of them out");
  }
  if (const auto drape = value.find("drape")) garment.drape = readDrape(*drape);
  if (garment.drape && !(garment.hem < garment.drape->from)) {
    value.find("drape")->fail(fmt::format("{}.from is {:g}, which is not above the hem",
                                          value.find("drape")->path(), garment.drape->from),
                              "let it hang from above the hem");
  }
  if (const auto front = value.find("front")) garment.front = readFront(*front);
  garment.hang = numberOr(value, "hang", 0.0f, 0.0, 1.0);
}

void readShoeKeys(const YamlValue& value, GarmentRecipe& garment) {
  garment.height = lengthOr(value, "height", garment.height, 5.0, 500.0);
  garment.slope = numberOr(value, "slope", 0.0f, -2.0, 2.0);
  if (const auto sole = value.find("sole")) garment.sole = readSole(*sole);
  if (const auto straps = value.find("straps")) {
    for (const YamlValue& strap : straps->items("a list of [from, to]")) {
      garment.straps.push_back(readInterval(strap, 0.0, 1.0));
    }
  }
}

void readHeadKeys(const YamlValue& value, GarmentRecipe& garment) {
  if (const auto hair = value.find("hair")) garment.hair = readHair(*hair);
  garment.edge = lengthOr(value, "edge", garment.edge, -150.0, 120.0);
  garment.edge_slope = numberOr(value, "edge_slope", garment.edge_slope, -2.0, 2.0);
  garment.strands = lengthOr(value, "strands", 0.0f, 0.0, 10.0);
}

void expectKindKeys(const YamlValue& value, GarmentKind kind) {
  switch (kind) {
    case GarmentKind::kBody:
      value.expectKeys({"name",    "kind",         "material",    "triangles", "color",    "pattern",
                        "texture", "texture_size", "thickness",   "trims",     "solids",   "cuts",
                        "avoid",   "attach",       "ease",        "hem",       "hem_rise", "top",
                        "neck",    "sleeves",      "sleeve_ease", "leg_ease",  "armhole",  "drape",
                        "front",   "hang"});
      return;
    case GarmentKind::kShoes:
      value.expectKeys({"name", "kind", "material", "triangles", "color", "pattern", "texture",
                        "texture_size", "thickness", "trims", "solids", "cuts", "avoid", "attach", "ease",
                        "height", "slope", "sole", "straps"});
      return;
    case GarmentKind::kHead:
      value.expectKeys({"name", "kind", "material", "triangles", "color", "pattern", "texture",
                        "texture_size", "thickness", "trims", "solids", "cuts", "avoid", "attach", "ease",
                        "hair", "edge", "edge_slope", "strands"});
      return;
  }
}

void readLooks(const YamlValue& value, const std::filesystem::path& folder, GarmentRecipe& garment) {
  if (const auto triangles = value.find("triangles")) {
    garment.triangles = static_cast<std::uint32_t>(triangles->wholeNumber(100, 20000));
  }
  if (const auto color = value.find("color")) garment.color = readColor(*color);
  if (const auto pattern = value.find("pattern")) garment.pattern = readPattern(*pattern);
  if (const auto texture = value.find("texture")) {
    if (garment.pattern.kind != PatternKind::kNone) {
      texture->fail(value.path() + " has both a pattern and a texture", "leave one of them out");
    }
    garment.texture = folder / texture->text("a file");
  }
  garment.texture_size = lengthOr(value, "texture_size", garment.texture_size, 5.0, 2000.0);
  if (const auto thickness = value.find("thickness")) garment.thickness = length(*thickness, 0.0, 20.0, true);
  if (const auto trims = value.find("trims")) {
    for (const YamlValue& trim : trims->items("a list of trims")) garment.trims.push_back(readTrim(trim));
    if (garment.trims.size() > 100) trims->fail(trims->path() + " has more than 100 trims", "leave some out");
  }
}

GarmentRecipe readGarment(const YamlValue& value, const std::filesystem::path& folder, Slot slot) {
  GarmentRecipe garment;
  garment.mark = value.mark();
  if (!value.isMap()) value.fail(value.description(), "give a map: {name: NAME, kind: body, ...}");
  const auto name = value.find("name");
  const auto kind = value.find("kind");
  if (!name || !kind) {
    value.fail(value.path() + " has no " + (name ? "kind" : "name"),
               name ? "add kind: body, shoes or head" : "add name: NAME");
  }
  garment.name = readName(*name);
  garment.kind = static_cast<GarmentKind>(kind->word({"body", "shoes", "head"}));
  expectKindKeys(value, garment.kind);
  garment.material = garment.kind == GarmentKind::kShoes ? "shoes" : slot == Slot::kHair ? "hair" : "cloth";
  if (const auto material = value.find("material")) garment.material = readMaterial(*material);
  readLooks(value, folder, garment);
  for (const auto& [key, list] : {std::pair("solids", &garment.solids), std::pair("cuts", &garment.cuts)}) {
    const auto solids = value.find(key);
    if (!solids) continue;
    for (const YamlValue& solid : solids->items("a list of solids")) list->push_back(readSolid(solid));
  }
  if (const auto avoid = value.find("avoid")) garment.avoid = {avoid->text("a region"), avoid->mark()};
  if (const auto attach = value.find("attach")) garment.attach = {attach->text("a joint"), attach->mark()};
  if (const auto ease = value.find("ease")) garment.ease = readProfile(*ease, 1.0, 120.0);
  if (garment.kind == GarmentKind::kBody) readBodyKeys(value, garment);
  if (garment.kind == GarmentKind::kShoes) readShoeKeys(value, garment);
  if (garment.kind == GarmentKind::kHead) readHeadKeys(value, garment);
  return garment;
}

void readJoints(const YamlValue& value, Recipe& recipe) {
  std::vector<std::string> known(landmarkNames().begin(), landmarkNames().end());
  for (const YamlValue& member : value.members("a map of joints")) {
    if (std::find(known.begin(), known.end(), member.key()) == known.end()) {
      member.fail("joints has no '" + member.key() + "'", "name one of " + quotedList(known));
    }
    recipe.joints[member.key()] = member.text("a joint");
    recipe.joint_marks[member.key()] = member.mark();
  }
}

}  // namespace

float Profile::at(float place) const {
  if (place <= points.front().first) return points.front().second;
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (place > points[i].first) continue;
    const auto& [from, low] = points[i - 1];
    return low + (points[i].second - low) * (place - from) / (points[i].first - from);
  }
  return points.back().second;
}

Recipe parseRecipe(const std::string& text, const std::filesystem::path& file) {
  const YamlDocument document = YamlDocument::parse(text, file);
  const YamlValue root = document.root();
  root.expectKeys({"version", "name", "slot", "layer", "joints", "garments"});
  const auto version = root.find("version");
  if (!version) root.fail("the file has no version", "add version: 1");
  version->wholeNumber(1, 1);
  Recipe recipe;
  recipe.file = file;
  const auto name = root.find("name");
  const auto slot = root.find("slot");
  const auto garments = root.find("garments");
  if (!name) root.fail("the file has no name", "add name: NAME, the file to write");
  if (!slot) root.fail("the file has no slot", "add slot: upper, for example");
  if (!garments) root.fail("the file has no garments", "add a list of garments (docs/authoring.md)");
  recipe.name = readName(*name);
  recipe.slot = kAllSlots[slot->word(kSlotNames)];
  if (const auto layer = root.find("layer")) {
    const double number = layer->number({.min = -1000.0, .max = 1000.0});
    recipe.layer = static_cast<int>(number);
    if (recipe.layer != number) layer->fail(layer->description(), "give a whole number from -1000 to 1000");
  }
  if (const auto joints = root.find("joints")) readJoints(*joints, recipe);
  for (const YamlValue& item : garments->items("a list of garments")) {
    GarmentRecipe garment = readGarment(item, file.parent_path(), recipe.slot);
    for (const GarmentRecipe& other : recipe.garments) {
      if (other.name == garment.name) {
        item.fail("the name '" + garment.name + "' is there twice", "give each garment a name of its own");
      }
    }
    recipe.garments.push_back(std::move(garment));
  }
  if (recipe.garments.empty()) garments->fail("garments is empty", "add a garment (docs/authoring.md)");
  checkRecipeSchema(root);
  return recipe;
}

Recipe loadRecipe(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = readFile(file, 1u << 20);
  return parseRecipe(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file);
}

}  // namespace ensemble
