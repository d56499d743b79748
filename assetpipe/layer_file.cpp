#include "assetpipe/layer_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/input_error.h"
#include "core/json_limits.h"

namespace ensemble {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "ensemble.layer/1";
constexpr std::size_t kDigits = 12;
constexpr std::uint64_t kMaxBytes = 64ull << 20;

std::string digits(const std::string& sha256) { return sha256.substr(0, kDigits); }

/// What a file says that it is of: all that its name says in short.
Json describePair(const Wardrobe& wardrobe, ItemPair pair, const HiddenFaceOptions& options) {
  return {
      {"schema", kSchema},
      {"inner", {{"name", wardrobe.items[pair.inner].name}, {"sha256", wardrobe.item_sha256[pair.inner]}}},
      {"outer", {{"name", wardrobe.items[pair.outer].name}, {"sha256", wardrobe.item_sha256[pair.outer]}}},
      {"key", layerKey(wardrobe.template_sha256, options)},
      {"faces", wardrobe.items[pair.inner].garmentFaceCount()}};
}

/// Hidden faces as [first, count] of runs.
Json runsOf(const HiddenGarmentFaces& hidden) {
  Json runs = Json::array();
  for (std::size_t face = 0; face < hidden.size();) {
    const auto end = static_cast<std::size_t>(
        std::find(hidden.begin() + static_cast<std::ptrdiff_t>(face), hidden.end(), hidden[face] ^ 1u) -
        hidden.begin());
    if (hidden[face] != 0) runs.push_back({face, end - face});
    face = end;
  }
  return runs;
}

/// The other way; nothing where they are no runs of so many faces.
std::optional<HiddenGarmentFaces> facesOf(const Json& runs, std::size_t count) {
  if (!runs.is_array()) return std::nullopt;
  HiddenGarmentFaces hidden(count, 0);
  for (const Json& run : runs) {
    if (!run.is_array() || run.size() != 2 || !run[0].is_number_unsigned() || !run[1].is_number_unsigned()) {
      return std::nullopt;
    }
    const std::uint64_t first = run[0], length = run[1];
    if (first > count || length > count - first) return std::nullopt;
    std::fill_n(hidden.begin() + static_cast<std::ptrdiff_t>(first), length, std::uint8_t{1});
  }
  return hidden;
}

}  // namespace

std::string layerKey(const std::string& template_sha256, const HiddenFaceOptions& options) {
  const std::string method =
      fmt::format("{} {} {} {} {} {} {} {}", kSchema, options.tolerance, options.hole_share,
                  options.hole_area, options.patch, options.samples, options.directions, options.poses);
  return digits(Sha256().feed(template_sha256).feed(method).hex());
}

fs::path layerFileName(const Wardrobe& wardrobe, ItemPair pair, const HiddenFaceOptions& options) {
  return fs::path("layers") /
         (digits(wardrobe.item_sha256[pair.inner]) + "-" + digits(wardrobe.item_sha256[pair.outer]) + "-" +
          layerKey(wardrobe.template_sha256, options) + ".json");
}

std::optional<HiddenGarmentFaces> readLayer(const Wardrobe& wardrobe, ItemPair pair,
                                            const HiddenFaceOptions& options) {
  const fs::path file = wardrobe.folder / layerFileName(wardrobe, pair, options);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    const std::vector<std::byte> bytes = readFile(file, kMaxBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    checkJsonLimits(text, file.string(), {.max_depth = 4}, "");
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object() || !json.contains("hidden")) return std::nullopt;
    const Json runs = json["hidden"];
    json.erase("hidden");
    if (json != describePair(wardrobe, pair, options)) return std::nullopt;
    return facesOf(runs, wardrobe.items[pair.inner].garmentFaceCount());
  } catch (const UserError&) {  // damaged, or gone meanwhile: it can be found again
    return std::nullopt;
  }
}

void writeLayer(const Wardrobe& wardrobe, ItemPair pair, const HiddenGarmentFaces& hidden,
                const HiddenFaceOptions& options) {
  const fs::path file = wardrobe.folder / layerFileName(wardrobe, pair, options);
  const FolderLock lock(wardrobe.folder);
  std::error_code error;
  fs::create_directory(file.parent_path(), error);
  if (error) failWriting(file.parent_path(), error.value());
  Json json = describePair(wardrobe, pair, options);
  json["hidden"] = runsOf(hidden);
  writeFileAtomically(file, json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void clearLayers(const fs::path& folder, const std::set<std::string>& items, const std::string& key) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "layers", error)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name.size() == 3 * kDigits + 7 && name[kDigits] == '-' &&
                         name[2 * kDigits + 1] == '-' && name.ends_with(".json");
    const bool is_left_over = name.starts_with('.') && name.ends_with(".tmp");
    const bool is_of_these = is_ours && items.contains(name.substr(0, kDigits)) &&
                             items.contains(name.substr(kDigits + 1, kDigits)) &&
                             name.substr(2 * kDigits + 2, kDigits) == key;
    if (is_left_over || (is_ours && !is_of_these)) fs::remove(entry.path(), error);
  }
  fs::remove(folder / "layers", error);  // where it is empty
}

}  // namespace ensemble
