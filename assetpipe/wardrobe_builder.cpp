#include "assetpipe/wardrobe_builder.h"

#include <set>
#include <system_error>

#include "assetpipe/layer_file.h"
#include "core/atomic_file.h"
#include "core/hash.h"
#include "core/input_error.h"

namespace ensemble {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHashDigits = 12;
constexpr std::uint64_t kMaxManifestBytes = 64ull << 20;

bool isHex(std::string_view text) {
  return text.size() == kHashDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Whether a name is one that we give: `NAME.HHHHHHHHHHHH.glb`, or what a killed writer left.
bool isOurs(const std::string& name) {
  if (name.starts_with('.') && name.ends_with(".tmp")) return true;
  if (!name.ends_with(".glb")) return false;
  const std::string stem = name.substr(0, name.size() - 4);
  const std::size_t dot = stem.rfind('.');
  return name == "template.glb" ||
         (dot != std::string::npos && isHex(std::string_view(stem).substr(dot + 1)));
}

void clearUnnamedFiles(const fs::path& folder, const std::set<std::string>& named,
                       const std::string& prefix) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file(error) && isOurs(name) && !named.contains(prefix + name))
      fs::remove(entry.path(), error);
  }
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw SystemError({folder.string(), "", "the folder can't be made: " + error.message(),
                       "choose a place that you may write to"});
  }
}

/// Whether a file is there with exactly this content.
bool holds(const fs::path& file, const std::string& sha256) {
  std::error_code error;
  return fs::is_regular_file(file, error) && sha256Hex(readFile(file)) == sha256;
}

}  // namespace

struct WardrobeWriter::Lock {
  FolderLock lock;
};

WardrobeWriter::WardrobeWriter(fs::path folder) : folder_(std::move(folder)) {
  makeFolder(folder_);
  lock_.reset(new Lock{FolderLock(folder_)});
  makeFolder(folder_ / "outfits");
}

WardrobeWriter::~WardrobeWriter() = default;

std::optional<Manifest> WardrobeWriter::currentManifest() const {
  const fs::path file = folder_ / "wardrobe.json";
  if (!fs::exists(file)) return std::nullopt;
  const std::vector<std::byte> bytes = readFile(file, kMaxManifestBytes);
  return parseManifest({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string());
}

std::string WardrobeWriter::writeTemplate(const std::vector<std::byte>& bytes, const std::string& sha256) {
  std::string name = "template.glb";
  // The old manifest may name that file until the commit: never replace it by another.
  if (fs::exists(folder_ / "wardrobe.json") && fs::exists(folder_ / name) && !holds(folder_ / name, sha256)) {
    name = "template." + sha256.substr(0, kHashDigits) + ".glb";
  }
  if (!holds(folder_ / name, sha256)) writeFileAtomically(folder_ / name, bytes);
  return name;
}

void WardrobeWriter::writeOutfit(const OutfitFile& outfit) {
  const fs::path file = folder_ / outfit.entry.file;
  if (!holds(file, outfit.entry.sha256)) writeFileAtomically(file, outfit.bytes);
}

void WardrobeWriter::commit(const Manifest& manifest) {
  writeFileAtomically(folder_ / "wardrobe.json", std::string_view(writeManifest(manifest)));
  std::set<std::string> named{manifest.body.file};
  for (const ManifestOutfit& outfit : manifest.outfits) named.insert(outfit.file);
  clearUnnamedFiles(folder_, named, "");
  clearUnnamedFiles(folder_ / "outfits", named, "outfits/");
  std::set<std::string> items;
  for (const ManifestOutfit& outfit : manifest.outfits) items.insert(outfit.sha256.substr(0, kHashDigits));
  clearLayers(folder_, items, layerKey(manifest.body.sha256, HiddenFaceOptions()));
}

std::string outfitFileName(const std::string& name, const std::string& sha256) {
  return "outfits/" + name + "." + sha256.substr(0, kHashDigits) + ".glb";
}

}  // namespace ensemble
