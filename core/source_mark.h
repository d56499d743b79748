// Where a value stood in its file, for messages that can only be made later (unknown outfit).
#pragma once

#include <string>

namespace ensemble {

struct SourceMark {
  int line = 0, column = 0;  ///< from 1; 0 where the value is a default or came from --set
  std::string key_path;      ///< "crowd.outfits.casual01"
  /// "line:column", or the key path where line is 0.
  std::string toString() const {
    return line > 0 ? std::to_string(line) + ":" + std::to_string(column) : key_path;
  }
};

template <class T>
struct Marked {
  T value{};
  SourceMark mark;
};

}  // namespace ensemble
