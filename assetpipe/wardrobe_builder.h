// Writes a wardrobe folder: atomically, one writer at a time (interfaces.md, "A wardrobe folder").
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/wardrobe_files.h"

namespace ensemble {

/// A file's bytes and where they go.
struct OutfitFile {
  ManifestOutfit entry;  ///< entry.file and entry.sha256 are of `bytes`
  std::vector<std::byte> bytes;
};

/// Holds the writers' lock on a wardrobe folder for its lifetime.
class WardrobeWriter {
 public:
  /// Makes the folder where it is missing and waits for other writers.
  explicit WardrobeWriter(std::filesystem::path folder);
  ~WardrobeWriter();
  WardrobeWriter(const WardrobeWriter&) = delete;
  WardrobeWriter& operator=(const WardrobeWriter&) = delete;

  /// The manifest as it is now; nothing where there is none yet.
  std::optional<Manifest> currentManifest() const;

  /// Writes the template under a name that no current file of other content has: `template.glb`,
  /// else `template.HHHHHHHHHHHH.glb`. Returns the name.
  std::string writeTemplate(const std::vector<std::byte>& bytes, const std::string& sha256);
  void writeOutfit(const OutfitFile& outfit);

  /// The commit: renames the manifest into place, then clears files that it does not name.
  void commit(const Manifest& manifest);

 private:
  struct Lock;
  std::filesystem::path folder_;
  std::unique_ptr<Lock> lock_;
};

/// `outfits/NAME.HHHHHHHHHHHH.glb`, the digits from the SHA-256.
std::string outfitFileName(const std::string& name, const std::string& sha256);

}  // namespace ensemble
