#include "assetpipe/recipe_schema.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/json_schema.h"
#include "embedded/kRecipeJsonSchema.h"

namespace ensemble {
namespace {

using nlohmann::json;

/// A bare number that is the whole text.
template <class Number>
std::optional<Number> parsed(const std::string& text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

json scalarToJson(const YamlValue& value) {
  const std::string text = value.text("a value");
  if (!value.isWord(text)) return text;  // in quotes
  if (text == "true" || text == "false") return text == "true";
  if (const auto integer = parsed<std::int64_t>(text)) return *integer;
  const auto number = parsed<double>(text);
  // `inf` and `nan` are words: JSON has no such numbers, and a garment may have such a name.
  return number && std::isfinite(*number) ? json(*number) : json(text);
}

/// The value that the steps of an error's context lead to, as far as they do.
YamlValue follow(YamlValue value, const std::vector<std::string>& steps) {
  for (const std::string& step : steps) {
    if (value.isMap()) {
      const auto found = value.find(step);
      if (!found) break;
      value = *found;
    } else if (value.isSequence()) {
      value = value.items("a list").at(std::stoul(step));
    }
  }
  return value;
}

}  // namespace

json toJson(const YamlValue& value) {
  if (value.isMap()) {
    json object = json::object();
    for (const YamlValue& member : value.members("a map")) object[member.key()] = toJson(member);
    return object;
  }
  if (value.isSequence()) {
    json list = json::array();
    for (const YamlValue& item : value.items("a list")) list.push_back(toJson(item));
    return list;
  }
  return value.isScalar() ? scalarToJson(value) : json();
}

void checkRecipeSchema(const YamlValue& root) {
  const std::optional<SchemaError> error = findSchemaError(toJson(root), kRecipeJsonSchema);
  if (!error) return;
  follow(root, error->path).fail("the recipe's schema refuses this: " + error->what, "see docs/authoring.md");
}

}  // namespace ensemble
