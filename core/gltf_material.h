// Materials, textures and images. Private to gltf_file.h's implementation.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "core/gltf_document.h"
#include "core/raw_asset.h"

namespace ensemble {

/// A material and how its texture finds its coordinates.
struct GltfMaterial {
  RawMaterial material;                ///< without its image
  std::optional<std::uint32_t> image;  ///< index into the document's images
  std::uint32_t uv_set = 0;            ///< TEXCOORD_n
  Mat3 uv_transform{1.0f};             ///< KHR_texture_transform
};

/// Collects what is read but can't be used, each once, in order.
class DroppedList {
 public:
  void add(const std::string& what) {
    if (seen_.insert(what).second) list_.push_back(what);
  }
  const std::vector<std::string>& list() const { return list_; }

 private:
  std::set<std::string> seen_;
  std::vector<std::string> list_;
};

/// All materials of the document, and a plain one at the end for primitives that name none.
std::vector<GltfMaterial> readMaterials(const GltfDocument& document, DroppedList& dropped,
                                        std::vector<std::string>& warnings);

/// Puts the materials that the asset's primitives use, and their images, into the asset, in the
/// file's order, and renumbers the primitives' materials. @throws InputError for images that are
/// missing, damaged or too large.
void addUsedMaterials(const GltfDocument& document, const std::vector<GltfMaterial>& materials,
                      RawAsset& asset);

}  // namespace ensemble
