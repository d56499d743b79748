// Parts of a scene's reader: what several of its maps have in common, and the placement. For scene.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/scene.h"
#include "core/yaml_reader.h"

namespace ensemble {

inline constexpr std::uint64_t kMaxCrowd = 2'000'000;

inline constexpr NumberRange kPositionRange{-1e6, 1e6, false, false, "metres"};
inline constexpr NumberRange kFpsRange{0.0, 1000.0, true, false, "frames a second"};
inline constexpr NumberRange kWeightRange{0.0, 1e6};

/// Degrees in the file. @throws InputError like all of these
float headingRadians(const YamlValue& value);
/// @param what it is, for the message if it is no text
Marked<std::string> readName(const YamlValue& value, const char* what);
/// One number, or [least, most].
std::array<float, 2> readSpan(const YamlValue& value, const NumberRange& allowed);

/// @param base the folder that file names start from
void readPlacement(const YamlValue& value, const std::filesystem::path& base, ScenePlacement& placement);

}  // namespace ensemble
