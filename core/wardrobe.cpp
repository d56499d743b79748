#include "core/wardrobe.h"

#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "core/hash.h"
#include "core/input_error.h"
#include "core/wardrobe_files.h"

namespace ensemble {
namespace {

constexpr std::uint64_t kMaxManifestBytes = 64ull << 20;
constexpr const char* kMend = "copy the whole folder again, or make it with `ensemble tag`";

std::string textOf(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A file that the manifest names, checked against its SHA-256 and read without welding.
RawAsset readChecked(const std::filesystem::path& folder, const std::string& file,
                     const std::string& sha256) {
  const std::filesystem::path path = folder / file;
  if (!std::filesystem::exists(path)) {
    throw InputError({path.string(), "", "this file of the wardrobe is missing", kMend});
  }
  const std::vector<std::byte> bytes = readFile(path);
  if (sha256Hex(bytes) != sha256) {
    throw InputError(
        {path.string(), "", "this file is damaged: its SHA-256 is not the one in wardrobe.json", kMend});
  }
  GltfReadOptions options;
  options.weld = false;
  return readGlb(bytes, path.string(), options);
}

void checkTemplate(const TemplateBody& body, const ManifestTemplate& manifest, const std::string& file) {
  bool same = body.faces.size() == manifest.faces && body.vertices.size() == manifest.vertices &&
              body.skeleton.joints.size() == manifest.joints &&
              body.regions.size() == manifest.regions.size() && body.clips.size() == manifest.clips.size();
  for (std::size_t r = 0; same && r < body.regions.size(); ++r) {
    const Region& region = body.regions[RegionId(r)];
    same = region.name == manifest.regions[r].name && region.face_count == manifest.regions[r].faces;
  }
  for (std::size_t c = 0; same && c < body.clips.size(); ++c) {
    same = body.clips[c].name == manifest.clips[c].name && body.clips[c].key_count == manifest.clips[c].keys;
  }
  if (!same) throw InputError({file, "/template", "the manifest describes another template", kMend});
}

Wardrobe loadOnce(const std::filesystem::path& folder, const std::string& manifest_text) {
  const std::string manifest_file = (folder / "wardrobe.json").string();
  const Manifest manifest = parseManifest(manifest_text, manifest_file);
  Wardrobe wardrobe;
  wardrobe.folder = folder;
  wardrobe.template_file = manifest.body.file;
  wardrobe.template_sha256 = manifest.body.sha256;
  wardrobe.geometry_hash = manifest.body.geometry_hash;
  wardrobe.body = templateFromAsset(readChecked(folder, manifest.body.file, manifest.body.sha256),
                                    (folder / manifest.body.file).string());
  checkTemplate(wardrobe.body, manifest.body, manifest_file);

  for (std::size_t i = 0; i < manifest.outfits.size(); ++i) {
    const ManifestOutfit& entry = manifest.outfits[i];
    const std::string path = (folder / entry.file).string();
    Item item = itemFromAsset(readChecked(folder, entry.file, entry.sha256), wardrobe.body,
                              wardrobe.geometry_hash, path);
    Manifest claimed, held;
    claimed.outfits = {entry};
    held.outfits = {manifestEntry(item, wardrobe.body, entry.file, entry.sha256)};
    if (writeManifest(claimed) != writeManifest(held)) {
      throw InputError({manifest_file, "/outfits/" + std::to_string(i),
                        "the manifest describes another outfit than its file '" + entry.file + "' holds",
                        kMend});
    }
    wardrobe.items.push(std::move(item));
    wardrobe.item_files.push(entry.file);
    wardrobe.item_sha256.push(entry.sha256);
  }
  return wardrobe;
}

}  // namespace

const char* toString(Visibility visibility) {
  switch (visibility) {
    case Visibility::kFull:
      return "full";
    case Visibility::kPartial:
      return "partial";
    case Visibility::kHidden:
      return "hidden";
  }
  return "?";
}

std::uint32_t Item::garmentFaceCount() const {
  std::size_t count = 0;
  for (const Garment& garment : garments) {
    for (const ItemPart& part : garment.parts) count += part.faces.size();
  }
  return static_cast<std::uint32_t>(count);
}

std::uint32_t Item::visibleBodyFaceCount() const {
  std::uint32_t count = 0;
  for (const RegionTag& tag : tags) count += tag.visible_faces;
  return count;
}

std::uint32_t Item::dedicatedFaceCount() const {
  std::uint32_t count = 0;
  for (const RegionTag& tag : tags) count += tag.visibility == Visibility::kPartial ? tag.visible_faces : 0;
  return count;
}

Wardrobe loadWardrobe(const std::filesystem::path& folder) {
  const std::filesystem::path manifest_file = folder / "wardrobe.json";
  if (!std::filesystem::exists(manifest_file)) {
    throw InputError({folder.string(), "", "there is no wardrobe here (no wardrobe.json)",
                      "give a folder made by `ensemble tag`"});
  }
  // A writer may commit, and clear the old files, while we read: then the manifest has changed.
  constexpr int kTries = 4;
  std::string text = textOf(readFile(manifest_file, kMaxManifestBytes));
  for (int attempt = 1;; ++attempt) {
    try {
      return loadOnce(folder, text);
    } catch (const UserError&) {
      std::string text_now = textOf(readFile(manifest_file, kMaxManifestBytes));
      if (attempt == kTries || text_now == text) throw;
      text = std::move(text_now);
    }
  }
}

}  // namespace ensemble
