// What JSON text may claim, scanned before a parser sees it: nesting, and number of values.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ensemble {

struct JsonLimits {
  std::uint32_t max_depth = 64;           ///< of arrays and objects inside each other
  std::uint64_t max_values = 1ull << 22;  ///< each costs the parsed document up to some hundred bytes
};

/// Scans text, malformed or not. @throws InputError "FILE: byte N: ...; MEND"
void checkJsonLimits(std::string_view text, const std::string& file, const JsonLimits& limits,
                     const std::string& mend);

}  // namespace ensemble
