#include "cli/frame_list.h"

#include <charconv>
#include <numeric>
#include <set>
#include <string_view>

#include "core/input_error.h"

namespace ensemble::cli {
namespace {

constexpr std::uint64_t kMostFrames = 1'000'000;

[[noreturn]] void refuse(std::string_view part) {
  throw UsageError({.file = {},
                    .where = "--frames",
                    .what = "'" + std::string(part) + "' is no frame and no range of frames",
                    .mend = "write numbers and ranges A-B from 0 to 999999, parted by commas: 0-9,20"});
}

std::uint32_t parseNumber(std::string_view text, std::string_view part) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number >= kMostFrames) refuse(part);
  return number;
}

}  // namespace

std::vector<std::uint32_t> parseFrames(const std::string& text, std::uint32_t frame_count) {
  std::vector<std::uint32_t> frames;
  if (text.empty()) {
    frames.resize(frame_count);
    std::iota(frames.begin(), frames.end(), 0u);
    return frames;
  }
  std::set<std::uint32_t> seen;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    const std::string_view part = rest.substr(0, comma);
    more = comma != std::string_view::npos;
    rest = more ? rest.substr(comma + 1) : std::string_view();
    const std::size_t dash = part.find('-');
    const std::uint32_t first = parseNumber(part.substr(0, dash), part);
    const std::uint32_t last =
        dash == std::string_view::npos ? first : parseNumber(part.substr(dash + 1), part);
    if (last < first) refuse(part);
    for (std::uint32_t frame = first; frame <= last; ++frame) {
      if (seen.insert(frame).second) frames.push_back(frame);
    }
  }
  return frames;
}

}  // namespace ensemble::cli
