// `ensemble report`: faces and bytes of naive, pre-fitted and tagged storage (Lister table 2).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "core/sub_mesh_lists.h"
#include "core/wardrobe.h"

namespace ensemble {

/// What the count of one outfit needs.
struct OutfitFaces {
  std::uint64_t garments = 0;      ///< faces of its clothes
  std::uint64_t visible_body = 0;  ///< body faces that show under it
  std::uint64_t dedicated = 0;     ///< of these, faces of partial regions
};

/// Stored faces of the three techniques, by Technique.
struct StoredFaces {
  std::array<std::uint64_t, 3> of{};
  std::uint64_t operator[](Technique technique) const { return of[static_cast<std::size_t>(technique)]; }
};

/// As the paper's table 2 counts: naive = template + garments; pre-fitted = garments + visible body
/// of every outfit, no template; tagged = template + garments + dedicated sub-meshes.
StoredFaces countStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits);

/// The same for `outfit_count` outfits of average size (the paper's figure 6), rounded.
StoredFaces extrapolateStoredFaces(std::uint64_t template_faces, std::span<const OutfitFaces> outfits,
                                   std::uint64_t outfit_count);

struct Report {
  std::uint64_t template_faces = 0;
  std::vector<std::string> outfit_names;
  std::vector<OutfitFaces> outfits;
  std::vector<std::string> region_names;     ///< of the template
  std::vector<std::vector<RegionTag>> tags;  ///< per outfit, per region
  std::vector<std::uint64_t> region_faces;   ///< of the template
  StoredFaces faces;
  std::array<std::uint64_t, 3> bytes{};  ///< what the GPU holds for meshes
  std::uint64_t lower_bound_bytes = 0;
};

/// Counts a wardrobe; bytes are those of the lists that the renderer draws.
Report makeReport(const Wardrobe& wardrobe);

nlohmann::ordered_json toJson(const Report& report);  ///< "ensemble.report/1"
std::string toTable(const Report& report);            ///< for people, with a newline at the end
std::string toCsv(const Report& report);              ///< one line per outfit, and the three totals

}  // namespace ensemble
