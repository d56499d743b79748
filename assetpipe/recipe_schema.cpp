#include "assetpipe/recipe_schema.h"

#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "embedded/kRecipeJsonSchema.h"

namespace ensemble {
namespace {

using nlohmann::json;

json scalarToJson(const YamlValue& value) {
  const std::string text = value.text("a value");
  if (!value.isWord(text)) return text;  // in quotes
  if (text == "true" || text == "false") return text == "true";
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number) return text;
  if (text.find_first_of(".eE") == std::string::npos) return std::stoll(text.substr(0, 18));
  return number;
}

/// The value that the steps of an error's context lead to, as far as they do.
YamlValue follow(YamlValue value, const std::vector<std::string>& steps) {
  for (const std::string& step : steps) {
    if (step.size() < 3 || step.front() != '[') continue;
    const std::string key = step.substr(1, step.size() - 2);
    if (value.isMap()) {
      const auto found = value.find(key);
      if (!found) break;
      value = *found;
    } else if (value.isSequence()) {
      value = value.items("a list").at(std::stoul(key));
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
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const json schema_document = json::parse(kRecipeJsonSchema);
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_document), schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  const json document = toJson(root);
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results)) return;
  valijson::ValidationResults::Error error;
  results.popError(error);
  std::string what = error.description;
  while (!what.empty() && what.back() == '.') what.pop_back();
  follow(root, error.context).fail("the recipe's schema refuses this: " + what, "see docs/authoring.md");
}

}  // namespace ensemble
