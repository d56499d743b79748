#include "core/scene_keys.h"

#include <fmt/format.h>

#include <vector>

namespace ensemble {
namespace {

constexpr NumberRange kHeadingRange{-360.0, 360.0, false, false, "degrees"};

}  // namespace

float headingRadians(const YamlValue& value) { return radians(value.numberFloat(kHeadingRange)); }

Marked<std::string> readName(const YamlValue& value, const char* what) {
  return {value.text(what), value.mark()};
}

std::array<float, 2> readSpan(const YamlValue& value, const NumberRange& allowed) {
  if (!value.isSequence()) {
    const float number = value.numberFloat(allowed);
    return {number, number};
  }
  const std::vector<YamlValue> ends = value.items("");
  if (ends.size() != 2) {
    value.fail(fmt::format("{} is a list of {}", value.path(), ends.size()),
               "give [least, most] or one number");
  }
  const std::array<float, 2> range{ends[0].numberFloat(allowed), ends[1].numberFloat(allowed)};
  if (range[0] > range[1]) {
    value.fail(fmt::format("{} begins with the greater number", value.path()), "give [least, most]");
  }
  return range;
}

}  // namespace ensemble
