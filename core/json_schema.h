// JSON documents against a JSON Schema. The only user of valijson.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ensemble {

struct SchemaError {
  std::vector<std::string> path;  ///< keys and indices (from 0) that lead to the value; empty: the whole
  std::string what;               ///< as the validator says it, without a full stop
};

/// What a schema refuses of a document: the most exact error; none if it is valid.
/// @param schema a JSON Schema (draft 7), ours and valid
std::optional<SchemaError> findSchemaError(const nlohmann::json& document, const char* schema);

}  // namespace ensemble
