#include "core/json_schema.h"

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace ensemble {

std::optional<SchemaError> findSchemaError(const nlohmann::json& document, const char* schema) {
  valijson::Schema parsed;
  valijson::SchemaParser parser;
  const nlohmann::json schema_document = nlohmann::json::parse(schema);
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_document), parsed);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(parsed, valijson::adapters::NlohmannJsonAdapter(document), &results)) return {};

  // The last error added is the most general, the first the most exact.
  valijson::ValidationResults::Error first;
  results.popError(first);
  SchemaError error;
  for (const std::string& step : first.context) {
    if (step == "<root>") continue;
    const bool in_brackets = step.size() > 2 && step.front() == '[';
    error.path.push_back(in_brackets ? step.substr(1, step.size() - 2) : step);
  }
  error.what = first.description;  // a sentence; our messages have no full stop
  while (error.what.ends_with('.')) error.what.pop_back();
  return error;
}

}  // namespace ensemble
