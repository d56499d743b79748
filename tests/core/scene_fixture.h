// Scenes from text, and the messages of wrong ones.
#pragma once

#include <string>
#include <vector>

#include "core/input_error.h"
#include "core/scene.h"

namespace ensemble::testing {

inline constexpr const char* kSceneFile = "scenes/a.yaml";
inline const std::string kHead = "version: 1\nwardrobe: w\n";

inline Scene parse(const std::string& text, const std::vector<SceneOverride>& overrides = {}) {
  return parseScene(text, kSceneFile, overrides);
}

/// The message that reading `text` ends in, with the kind of error before it.
inline std::string errorOf(const std::string& text, const std::vector<SceneOverride>& overrides = {}) {
  try {
    parse(text, overrides);
  } catch (const InputError& error) {
    return std::string("input: ") + error.what();
  } catch (const UsageError& error) {
    return std::string("usage: ") + error.what();
  }
  return "no error";
}

/// The message for `lines` after a valid head of two lines, without the file's name.
inline std::string errorAfterHead(const std::string& lines) {
  const std::string message = errorOf(kHead + lines);
  const std::string start = std::string("input: ") + kSceneFile + ": ";
  return message.rfind(start, 0) == 0 ? message.substr(start.size()) : message;
}

}  // namespace ensemble::testing
