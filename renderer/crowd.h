// From a scene to people: who stands where, in what, moving how.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/math.h"
#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/journey.h"
#include "renderer/walker.h"

namespace ensemble {

/// A combination of one wardrobe that somebody of the crowd wears.
struct WornCombination {
  std::uint32_t wardrobe = 0;  ///< index into Scene::wardrobes
  Combination items;
  auto operator<=>(const WornCombination&) const = default;
};

/// One person at time 0.
struct Character {
  std::uint32_t wardrobe = 0;     ///< index into Scene::wardrobes
  std::uint32_t combination = 0;  ///< index into Crowd::combinations
  std::uint32_t clip = 0;         ///< index into that wardrobe's TemplateBody::clips; 0 if it has none
  float phase = 0.0f;             ///< part of the clip that has run at time 0, 0 .. 1
  float speed = 1.0f;             ///< factor on the clip's speed
  Vec3 position{0.0f};
  float heading = 0.0f;  ///< radians about +Y, 0 looks along +Z
  float scale = 1.0f;
  std::uint32_t tint_seed = 0;
  /// Who walks along a path or trajectory: index into Crowd::walkers. Then `clip` is the walk, and
  /// phase, position and heading are those at time 0.
  std::optional<std::uint32_t> walker;

  Mat4 worldFromModel() const;
};

struct Crowd {
  std::vector<Character> characters;          ///< `people` in file order, then the crowd
  std::vector<WornCombination> combinations;  ///< distinct, by wardrobe, then by items
  std::vector<Journey> journeys;
  std::vector<WalkStyle> walk_styles;
  std::vector<Walker> walkers;
};

/// Somebody of the crowd at a time.
struct CharacterPose {
  Mat4 world_from_model{1.0f};
  Vec3 position{0.0f};
  float heading = 0.0f;
  std::uint32_t clip = 0;       ///< of the wardrobe's template
  float phase = 0.0f;           ///< part of the clip that has run
  std::uint32_t idle_clip = 0;  ///< blended in by idle_weight
  float idle_phase = 0.0f, idle_weight = 0.0f;
  bool holds_feet = false;
  std::array<FootShift, 2> feet;
  bool exists = true;
};

/// @param clip_seconds of the character's clip
CharacterPose poseAt(const Crowd& crowd, const Character& character, float clip_seconds, double seconds,
                     FeetOf feet = FeetOf::kAll);

/// Fills a scene's placements. The same scene and wardrobes give the same crowd, on every machine
/// (random.h). What is random about a person depends on the seed and the person's number in the
/// crowd only, so that a change of weights or scale moves nobody. Weights of clothes count within the
/// wardrobe chosen for the person (CrowdClothes); a wardrobe without any item leaves people bare.
/// @param wardrobes one for each of scene.wardrobes
/// @throws InputError with line:column for an outfit, clip or wardrobe that does not exist, naming
/// the nearest; for a bare outfit name that several wardrobes have; for a clip that one lacks; for
/// a wardrobe that can't dress a person; for items that exclude each other; for a spacing that can't be kept
/// so far from the origin; for a clip without ground speed where people walk; for paths and files that can't
/// be followed; for a crowd table as CrowdOfTable.
Crowd populateCrowd(const Scene& scene, std::span<const Wardrobe> wardrobes);

}  // namespace ensemble
