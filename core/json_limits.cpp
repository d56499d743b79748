#include "core/json_limits.h"

#include <fmt/format.h>

#include "core/input_error.h"

namespace ensemble {

void checkJsonLimits(std::string_view text, const std::string& file, const JsonLimits& limits,
                     const std::string& mend) {
  std::uint32_t depth = 0;
  std::uint64_t values = 1;  // one more than there are commas and brackets
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const auto fail = [&](const std::string& what) {
      throw InputError({file, fmt::format("byte {}", i), what, mend});
    };
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > limits.max_depth)
        fail(fmt::format("the JSON is nested more than {} deep", limits.max_depth));
      ++values;
    } else if ((c == ']' || c == '}') && depth > 0) {
      --depth;
    } else if (c == ',') {
      ++values;
    }
    if (values > limits.max_values) fail(fmt::format("the JSON has more than {} values", limits.max_values));
  }
}

}  // namespace ensemble
