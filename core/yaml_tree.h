// Inside yaml_reader: from yaml-cpp's events to a tree.
#pragma once

#include <string>

#include "core/yaml_reader.h"

namespace ensemble {

/// What is wrong with a text, and where: line and column from 1, 0 where there is no place.
struct YamlSyntaxError {
  int line = 0, column = 0;
  std::string what, mend;
};

/// The text's only document; a null node for an empty text. @throws YamlSyntaxError
YamlNode readYamlTree(const std::string& text, const YamlLimits& limits);

}  // namespace ensemble
