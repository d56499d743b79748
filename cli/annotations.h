// What `render --annotations` writes of a frame (interfaces.md, "More than a picture").
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "core/scene.h"
#include "core/wardrobe.h"
#include "renderer/ground_truth.h"

namespace ensemble::cli {

/// What is the same for all frames: {"schema": "ensemble.annotations/1", "width", "height", "fps",
/// "crowd_sha256", "wardrobes": [{"name", "joints": [names], "parents": [indices, -1 for a root]}]}
nlohmann::ordered_json annotationHeader(const Scene& scene, std::span<const Wardrobe> wardrobes,
                                        const Crowd& crowd);

/// {"frame", "file", "seconds", "camera": {"intrinsics", "camera_from_world", "clip_from_world"}: rows,
///  "people": [{"number", "id", "wardrobe", "outfit", "clip", "bbox", "bbox_whole", "pixels",
///  "pixels_alone", "visible", "bbox_3d": {"center", "size", "heading"}, "joints_2d": [[x, y, v]],
///  "joints_3d": [[x, y, z]]}]}; docs/pictures.md explains each.
nlohmann::ordered_json annotateFrame(const Scene& scene, std::span<const Wardrobe> wardrobes,
                                     const Crowd& crowd, const View& view, const Picture& picture,
                                     std::uint32_t frame, const std::string& file);

}  // namespace ensemble::cli
