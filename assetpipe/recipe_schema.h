// Recipes against their JSON Schema (outfits/schema/recipe.schema.json).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/yaml_reader.h"

namespace ensemble {

/// A YAML value as JSON: bare numbers and truth values as such, everything else as text.
nlohmann::json toJson(const YamlValue& value);

/// @throws InputError FILE: LINE:COLUMN: ... at the value that the schema refuses
void checkRecipeSchema(const YamlValue& root);

}  // namespace ensemble
