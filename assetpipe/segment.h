// From a template as an artist exported it to regions (Lister section 3.1.3): by material, by
// dominant joint, or as a file says.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/raw_asset.h"
#include "core/wardrobe.h"

namespace ensemble {

/// One region of a `--regions FILE`: it takes the faces that its lists name and that no region
/// before it has taken.
struct RegionRule {
  std::string name;
  std::vector<std::string> materials;
  std::vector<std::string> joints;  ///< faces whose largest summed skin weight is one of these
  std::vector<std::pair<std::uint32_t, std::uint32_t>> faces;  ///< inclusive, in the file's order
};

enum class SegmentBy : std::uint8_t { kMaterial, kJoints, kRules };

struct SegmentOptions {
  SegmentBy by = SegmentBy::kMaterial;
  std::vector<RegionRule> rules;  ///< for kRules
  std::string body_node;          ///< take this node alone as the body; empty: every skinned node
};

/// Makes the template body: faces sorted by region (by first appearance), inside a region in the
/// file's order; vertices welded, each in one region; wedges of one position share skin weights
/// (design 2: the first one's, told in `warnings`). Clips are sampled to key frames.
/// @throws InputError if there is no skin, no faces, or faces that no region takes.
TemplateBody segmentTemplate(const RawAsset& asset, const SegmentOptions& options, const std::string& file,
                             std::vector<std::string>& warnings);

/// Reads a `--regions FILE`: YAML, `regions: {NAME: {materials: [...], joints: [...], faces: [0-99, 120]}}`.
std::vector<RegionRule> readRegionRules(const std::string& file);

/// A name without the `.001` that Blender adds to copies.
std::string_view withoutBlenderSuffix(std::string_view name);

/// The part of the body that a joint's name speaks of ("head", "hands", "feet", "arms", "torso",
/// "legs"), or empty. Knows the words of MakeHuman, Mixamo, DAZ, Rigify and Unreal.
std::string bodyPartOfJoint(std::string_view joint_name);

}  // namespace ensemble
