// A people configuration: strict YAML, documented in docs/people.md.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include "assetpipe/built_in_recipes.h"
#include "assetpipe/make_people.h"
#include "assetpipe/people_colors.h"
#include "core/atomic_file.h"
#include "core/color.h"
#include "core/nearest_name.h"
#include "core/yaml_reader.h"

namespace ensemble {
namespace {

/// A colour by name or as [r, g, b] in sRGB; linear.
Vec3 readColor(const YamlValue& value, std::span<const NamedColor> named) {
  if (value.isSequence()) {
    return linearFromSrgb(value.vector({.min = 0.0, .max = 1.0}));
  }
  const std::string name = value.text("a colour's name or [r, g, b]");
  std::vector<std::string> known;
  for (const NamedColor& color : named) {
    if (color.name == name) return linearFromSrgb(color.srgb);
    known.emplace_back(color.name);
  }
  value.fail(value.description() + ", which is no colour known here",
             "write " + quotedList(known) + " or [r, g, b] from 0 to 1");
}

std::string readName(const YamlValue& value) {
  std::string name = value.text("a name");
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  if (name.size() > 64 || name.find_first_not_of(kAllowed) != std::string::npos) {
    value.fail(value.description() + ", which can't be a folder's name",
               "use up to 64 letters, digits, '-' and '_'");
  }
  return name;
}

std::vector<std::string> readOutfits(const YamlValue& value) {
  const std::vector<std::string> known = builtInRecipeNames();
  std::vector<std::string> chosen;
  for (const YamlValue& item : value.items("a list of outfits")) {
    const std::string name = item.text("an outfit's name");
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      item.fail(item.description() + ", which is no recipe of the program's",
                "did you mean " + quotedList(nearestNames(name, known)) + "? There are " +
                    quotedList(known, "and"));
    }
    if (std::find(chosen.begin(), chosen.end(), name) != chosen.end()) {
      item.fail(item.description() + ", which is there twice", "leave one out");
    }
    chosen.push_back(name);
  }
  if (chosen.empty()) value.fail(value.path() + " is empty", "name an outfit or leave the key out");
  return chosen;
}

/// Metres.
float defaultHeight(Sex sex, AgeGroup age) {
  if (age == AgeGroup::kYoung) return sex == Sex::kFemale ? 1.60f : 1.65f;
  if (age == AgeGroup::kOld) return sex == Sex::kFemale ? 1.61f : 1.73f;
  return sex == Sex::kFemale ? 1.66f : 1.78f;
}

PersonConfig readPerson(const YamlValue& value) {
  value.expectKeys(
      {"name", "sex", "age", "height", "girth", "build", "seed", "skin", "hair", "outfits", "faces"});
  PersonConfig person;
  const auto name = value.find("name");
  const auto sex = value.find("sex");
  if (!name || !sex) {
    value.fail(value.path() + " has no " + (name ? "sex" : "name"),
               name ? "add sex: female or sex: male" : "add name: NAME, the folder to write");
  }
  person.name = readName(*name);
  person.figure.sex = sex->word({"female", "male"}) == 0 ? Sex::kFemale : Sex::kMale;
  if (const auto age = value.find("age")) {
    constexpr AgeGroup kGroups[] = {AgeGroup::kYoung, AgeGroup::kAdult, AgeGroup::kOld};
    person.figure.age = kGroups[age->word({"young", "adult", "old"})];
  }
  person.figure.height = defaultHeight(person.figure.sex, person.figure.age);
  if (const auto height = value.find("height")) {
    person.figure.height = height->numberFloat({.min = 1.4, .max = 2.1, .unit = "metres"});
  }
  if (const auto girth = value.find("girth"))
    person.figure.girth = girth->numberFloat({.min = -1.0, .max = 1.0});
  if (const auto build = value.find("build"))
    person.figure.build = build->numberFloat({.min = -1.0, .max = 1.0});
  if (const auto seed = value.find("seed")) person.seed = seed->wholeNumber(0, 0xffffffffull);
  person.colors = pickColors(person.seed);
  if (person.figure.age == AgeGroup::kOld) person.colors.hair = linearFromSrgb(greyHair());
  if (const auto skin = value.find("skin")) person.colors.skin = readColor(*skin, skinTones());
  if (const auto hair = value.find("hair")) person.colors.hair = readColor(*hair, hairColors());
  if (const auto outfits = value.find("outfits")) person.outfits = readOutfits(*outfits);
  if (const auto faces = value.find("faces")) {
    person.body_faces = static_cast<std::uint32_t>(faces->wholeNumber(1500, 20000));
  }
  return person;
}

}  // namespace

PeopleConfig parsePeopleConfig(const std::string& text, const std::filesystem::path& file) {
  const YamlDocument document = YamlDocument::parse(text, file);
  const YamlValue root = document.root();
  root.expectKeys({"version", "people"});
  const auto version = root.find("version");
  if (!version) root.fail("the file has no version", "add version: 1");
  version->wholeNumber(1, 1);
  const auto people = root.find("people");
  if (!people) root.fail("the file has no people", "add people: [{name: woman, sex: female}]");
  PeopleConfig config;
  for (const YamlValue& item : people->items("a list of people")) {
    PersonConfig person = readPerson(item);
    for (const PersonConfig& other : config.people) {
      if (other.name == person.name)
        item.fail("the name '" + person.name + "' is there twice", "give each person a name of its own");
    }
    config.people.push_back(std::move(person));
  }
  if (config.people.empty()) people->fail("people is empty", "add {name: woman, sex: female}");
  return config;
}

PeopleConfig loadPeopleConfig(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = readFile(file, 4u << 20);
  return parsePeopleConfig(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file);
}

}  // namespace ensemble
