// `ensemble report`: faces and bytes of naive, pre-fitted and tagged storage (Lister table 2).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "assetpipe/combination_storage.h"
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

/// Faces or bytes by what they are for.
struct StoredParts {
  std::uint64_t body = 0;      ///< the template, which outfits share
  std::uint64_t garments = 0;  ///< of clothes
  std::uint64_t fitted = 0;    ///< body made for outfits: pre-fitted bodies, or dedicated sub-meshes
  std::uint64_t sum() const { return body + garments + fitted; }
};
using TechniqueParts = std::array<StoredParts, 3>;  ///< by Technique

/// Faces that an outfit adds to the store, without the template.
TechniqueParts outfitFaceParts(const OutfitFaces& faces);

/// One number of outfits of the paper's figure 6.
struct ExtrapolatedFaces {
  std::uint64_t outfits = 0;
  StoredFaces faces;
  std::optional<double> tagged_vs_prefitted = {};  ///< none where pre-fitted stores nothing
};

/// Figure 6: how storage grows with the number of outfits, from the wardrobe's mean outfit. Below
/// the wardrobe's own number a figure is the mean over all its subsets of that many, at it the
/// figure is counted, above it is extrapolated.
struct Extrapolation {
  std::uint64_t outfits = 0;  ///< up to here
  /// Ascending, from 1 to `outfits`: every number up to 100, else 100 at equal distances, and the
  /// wardrobe's own number where it lies between.
  std::vector<ExtrapolatedFaces> curve;
  std::optional<double> limit;  ///< tagged over pre-fitted towards infinitely many outfits
};
Extrapolation extrapolate(std::uint64_t template_faces, std::span<const OutfitFaces> outfits,
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
  TechniqueParts byte_parts;             ///< the same by what they are for
  /// Per outfit: bytes of the garments and the fitted body that it uses. What several outfits use
  /// counts at each of them here, and once in `bytes`.
  std::vector<TechniqueParts> outfit_bytes;
  std::uint64_t lower_bound_bytes = 0;
  std::optional<Extrapolation> extrapolation;
  WardrobeCombinations combinations;  ///< where items are combined
};

/// Counts a wardrobe; bytes are those of the lists that the renderer draws. `extrapolate_to`: number
/// of outfits of the extrapolation, 0 for none.
Report makeReport(const Wardrobe& wardrobe, std::uint64_t extrapolate_to = 0);

nlohmann::ordered_json toJson(const Report& report);  ///< "ensemble.report/1"
std::string toTable(const Report& report);            ///< for people, with a newline at the end
nlohmann::ordered_json toJson(const CombinationStorage& stored);
std::string toTable(const CombinationStorage& stored);
/// One table: a row for each technique of every outfit, of the total and of every number of outfits of
/// the extrapolation (`kind` as in the JSON, `name` the number), and the lower bound. A field without
/// a meaning is empty.
std::string toCsv(const Report& report);

}  // namespace ensemble
