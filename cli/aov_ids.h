// NAME.ids.json: what the numbers in a frame's AOVs mean (interfaces.md, "More than a picture").
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/renderer.h"

namespace ensemble::cli {

/// {"schema": "ensemble.ids/1", "characters": [{id, number, wardrobe, outfit, clip, tint_seed}],
///  "regions": [{id, wardrobe, name}], "garments": [{id, wardrobe, name}],
///  "outfits": [{wardrobe, name, file, garments: [ids]}], "faces", "depth", "normal": text}; `id` is what
/// the AOV's channel holds, `number` the person's in the crowd, from 0.
nlohmann::ordered_json aovIds(const Scene& scene, std::span<const Wardrobe> wardrobes, const Crowd& crowd,
                              const AovNumbers& numbers);

/// How a scene's wardrobe is called in figures: its key, or its folder where there is one only.
std::string wardrobeName(const SceneWardrobe& wardrobe);
/// Its entry "characters".
nlohmann::ordered_json describeCharacters(const Scene& scene, std::span<const Wardrobe> wardrobes,
                                          const Crowd& crowd);

}  // namespace ensemble::cli
