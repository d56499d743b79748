// The files of a wardrobe folder: manifest, template.glb, outfits/*.glb. Both ends of each format.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/raw_asset.h"
#include "core/wardrobe.h"

namespace ensemble {

// --- The manifest, wardrobe.json -----------------------------------------------------------------

struct ManifestRegion {
  std::string name;
  std::uint32_t faces = 0;
};
struct ManifestClip {
  std::string name;
  float seconds = 0.0f;
  std::uint32_t keys = 0;
  float ground_speed = 0.0f;
};
struct ManifestGarment {
  std::string name;
  std::uint32_t faces = 0;
};
struct ManifestTag {
  std::string name;
  Visibility visibility = Visibility::kFull;
  std::uint32_t template_faces = 0, visible_faces = 0;
};

struct ManifestTemplate {
  std::string file, sha256, geometry_hash;
  std::uint32_t faces = 0, vertices = 0, joints = 0;
  std::vector<ManifestRegion> regions;
  std::vector<ManifestClip> clips;
};

/// An outfit's entry; a function of its file's bytes alone (tag, ship, add give the same).
struct ManifestOutfit {
  std::string name, file, sha256;
  Slot slot = Slot::kFull;
  int layer = 0;
  std::vector<ManifestGarment> garments;
  std::vector<ManifestTag> regions;
};

struct Manifest {
  ManifestTemplate body;
  std::vector<ManifestOutfit> outfits;
};

/// JSON text, two spaces of indentation, a newline at the end. The same manifest gives the same bytes.
std::string writeManifest(const Manifest& manifest);

/// Checks text against the JSON Schema and reads it. File names that leave the folder, and names
/// that stand twice, are refused. @throws InputError with a JSON pointer; another schema version is
/// refused by name.
Manifest parseManifest(const std::string& text, const std::string& file);

// --- template.glb --------------------------------------------------------------------------------

/// A GLB's content for the template: node "body", one primitive per part, in face order; `extras`
/// tell the regions and the geometry hash.
RawAsset assetFromTemplate(const TemplateBody& body);

/// The other way. `asset` must have been read without welding. @throws InputError naming `file`.
TemplateBody templateFromAsset(const RawAsset& asset, const std::string& file);

/// SHA-256 of what tags depend on: positions, faces, regions and joint names.
std::string geometryHash(const TemplateBody& body);

// --- outfits/NAME.HHHHHHHHHHHH.glb ---------------------------------------------------------------

/// A GLB's content for an item: its garments, its partial regions with `_TEMPLATE_VERTEX`, its
/// extra body faces; `extras` tell name, slot, layer, classes and the template's geometry hash.
RawAsset assetFromItem(const Item& item, const TemplateBody& body, const std::string& geometry_hash);

/// Whether an asset is an already tagged outfit (known by its `extras`).
bool isTaggedItem(const RawAsset& asset);

/// Reads a tagged outfit; `asset` must have been read without welding. Its classes hold only for
/// the template it was tagged for. @throws InputError naming `file` if the hash differs, or if
/// classes, counts and faces contradict each other.
Item itemFromAsset(const RawAsset& asset, const TemplateBody& body, const std::string& geometry_hash,
                   const std::string& file);

/// An item's manifest entry, from what its file holds.
ManifestOutfit manifestEntry(const Item& item, const TemplateBody& body, std::string file,
                             std::string sha256);

/// Whether a name can stand in a file name and in a scene: 1 to 100 bytes, no control characters,
/// no '/', not starting with '.'.
bool isValidItemName(std::string_view name);

/// Finds template faces by their three vertices, whichever stands first; equal faces count up.
class FaceFinder {
 public:
  FaceFinder(const TemplateBody& body, const Region& region);
  /// The next face with these corners that was not given out yet, or none().
  FaceId take(const Triangle& template_vertices);

 private:
  struct Entry {
    Triangle corners;
    FaceId face;
    bool taken = false;
  };
  std::vector<Entry> entries_;  ///< sorted by corners, then face
};

}  // namespace ensemble
