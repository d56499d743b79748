// One person, looked at from sides that lie evenly over the sphere.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "renderer/renderer.h"

namespace ensemble::testing {

/// `scripts/test.sh --full` looks from more sides and at more times.
inline bool isFull() { return std::getenv("ENSEMBLE_FULL_TESTS") != nullptr; }

inline std::vector<View> viewsFromAllSides(const Scene& scene) {
  const int count = isFull() ? 60 : 12;
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    View view = viewOf(scene);
    const float up = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / static_cast<float>(count);
    const float out = std::sqrt(1.0f - up * up), turn = 2.399963f * static_cast<float>(i);
    view.camera.target = Vec3(0.0f, 0.9f, 0.0f);
    view.camera.position = view.camera.target + 4.0f * Vec3(out * std::cos(turn), up, out * std::sin(turn));
    view.aovs = {Aov::kCharacter, Aov::kRegion, Aov::kFace, Aov::kDepth};
    views.push_back(view);
  }
  return views;
}

/// Somebody in an outfit and a clip, in the middle of a picture of so many pixels each way.
inline Scene sceneOfOne(const std::string& outfit, const std::string& clip, Technique technique,
                        std::uint32_t size) {
  return parseScene(std::string("version: 1\nwardrobe: w\ntechnique: ") + toString(technique) +
                        "\noutput: {width: " + std::to_string(size) + ", height: " + std::to_string(size) +
                        ", samples: 1, background: transparent}\nlight: {shadows: false}\ncamera: {position: "
                        "[0, 1, 4], target: [0, 0.9, 0], fov_y: 30}\npeople:\n  - {outfit: " +
                        outfit + ", clip: " + clip + ", phase: 0, position: [0, 0, 0], heading: 0}\n",
                    "scene.yaml");
}

}  // namespace ensemble::testing
