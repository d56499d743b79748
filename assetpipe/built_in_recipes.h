// The recipes of outfits/, which the program holds as text, so that `ensemble people` needs no other files.
#pragma once

#include <string>
#include <vector>

#include "assetpipe/recipe.h"

namespace ensemble {

/// Their names, sorted.
std::vector<std::string> builtInRecipeNames();

/// @pre the name is one of them
Recipe builtInRecipe(const std::string& name);

}  // namespace ensemble
