// `--regions FILE`.
#include <charconv>

#include "assetpipe/segment.h"
#include "core/atomic_file.h"
#include "core/yaml_reader.h"

namespace ensemble {
namespace {

std::vector<std::string> readNames(const YamlValue& map, std::string_view key) {
  std::vector<std::string> names;
  if (const auto list = map.find(key)) {
    for (const YamlValue& item : list->items("a list of names")) names.push_back(item.text("a name"));
  }
  return names;
}

/// "12" or "0-99".
std::pair<std::uint32_t, std::uint32_t> readRange(const YamlValue& value) {
  const std::string text = value.text("a face number or a range such as 0-99");
  std::pair<std::uint32_t, std::uint32_t> range;
  const char* const end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, range.first);
  range.second = range.first;
  if (parsed.ec == std::errc() && parsed.ptr != end && *parsed.ptr == '-') {
    parsed = std::from_chars(parsed.ptr + 1, end, range.second);
  }
  if (parsed.ec != std::errc() || parsed.ptr != end || range.second < range.first) {
    value.fail("'" + text + "' is no range of faces", "write a number such as 12 or a range such as 0-99");
  }
  return range;
}

}  // namespace

std::vector<RegionRule> readRegionRules(const std::string& file) {
  const std::vector<std::byte> bytes = readFile(file, YamlLimits().max_bytes);
  const YamlDocument document =
      YamlDocument::parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
  const YamlValue root = document.root();
  root.expectKeys({"regions"});
  const auto regions = root.find("regions");
  if (!regions) root.fail("there is no key 'regions'", "write regions: {NAME: {joints: [...]}}");
  std::vector<RegionRule> rules;
  for (const YamlValue& region : regions->members("a map of regions")) {
    region.expectKeys({"materials", "joints", "faces"});
    RegionRule rule{region.key(), readNames(region, "materials"), readNames(region, "joints"), {}};
    if (const auto faces = region.find("faces")) {
      for (const YamlValue& range : faces->items("a list of face numbers"))
        rule.faces.push_back(readRange(range));
    }
    rules.push_back(std::move(rule));
  }
  if (rules.empty()) regions->fail("there are no regions", "name at least one");
  return rules;
}

}  // namespace ensemble
