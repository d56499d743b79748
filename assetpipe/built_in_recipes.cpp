#include "assetpipe/built_in_recipes.h"

#include <algorithm>
#include <iterator>

#include "core/check.h"
#include "embedded/kBuiltInRecipes.h"

namespace ensemble {

std::vector<std::string> builtInRecipeNames() {
  std::vector<std::string> names;
  for (const auto& [name, text] : kBuiltInRecipes) names.emplace_back(name);
  return names;
}

Recipe builtInRecipe(const std::string& name) {
  const auto found = std::find_if(std::begin(kBuiltInRecipes), std::end(kBuiltInRecipes),
                                  [&](const auto& entry) { return entry.first == name; });
  ENSEMBLE_CHECK(found != std::end(kBuiltInRecipes));
  return parseRecipe(std::string(found->second), "outfits/" + name + ".yaml");
}

}  // namespace ensemble
