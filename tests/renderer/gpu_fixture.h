// What the tests on a Vulkan device share.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/layers.h"
#include "renderer/renderer.h"
#include "tests/renderer/test_wardrobe.h"
#include "tests/support/garment_pixels.h"

namespace ensemble::testing {

/// Whether the validation layer is there: without it tests run unvalidated and say so.
inline bool hasValidationLayer() {
  static const bool has = [] {
    try {
      const Renderer renderer({.validate = true});
      return true;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "no validation: %s\n", error.what());
      return false;
    }
  }();
  return has;
}

/// Renders in-memory people. At the end of a test the validation layer must have said nothing.
class GpuTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (deviceName() == "none")
      GTEST_SKIP() << "there is no Vulkan device: nothing of the renderer is tested";
    wardrobes_.push_back(tubeWardrobe());
  }

  std::unique_ptr<Renderer> makeRenderer(const Scene& scene, RendererOptions options = {}) {
    options.validate = hasValidationLayer();
    auto renderer = std::make_unique<Renderer>(options);
    renderer->load(scene, wardrobes_);
    return renderer;
  }

  static Picture draw(Renderer& renderer, const View& view, double seconds = 0.0) {
    Picture picture;
    renderer.render(std::span(&view, 1), seconds, std::span(&picture, 1));
    EXPECT_THAT(renderer.validationMessages(), ::testing::IsEmpty());
    return picture;
  }

  /// One picture with a renderer of its own.
  Picture drawScene(const Scene& scene, const View& view, double seconds = 0.0,
                    RendererOptions options = {}) {
    const auto renderer = makeRenderer(scene, options);
    return draw(*renderer, view, seconds);
  }

  std::vector<Wardrobe> wardrobes_;
};

inline AovSet allAovs() {
  AovSet set;
  for (const Aov aov : kAllAovs) set.add(aov);
  return set;
}

/// Pixels whose colours differ.
inline std::vector<std::size_t> differingPixels(const Image8& a, const Image8& b) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < a.rgba.size() / 4; ++i) {
    bool same = true;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) same = same && a.rgba[k] == b.rgba[k];
    if (!same) pixels.push_back(i);
  }
  return pixels;
}

/// Of all that was asked for, to the last bit.
inline void expectSamePixels(const Picture& a, const Picture& b) {
  EXPECT_EQ(a.color.rgba, b.color.rgba);
  EXPECT_EQ(a.linear, b.linear);
  EXPECT_EQ(a.character, b.character);
  EXPECT_EQ(a.region, b.region);
  EXPECT_EQ(a.face, b.face);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.normal, b.normal);
}

/// Pixels that show somebody.
inline std::size_t countPeoplePixels(const Picture& picture) {
  return picture.character.size() -
         static_cast<std::size_t>(std::count(picture.character.begin(), picture.character.end(), 0u));
}

/// Whether a pixel of an AOV picture shows a template face that its person's clothes hide.
inline bool showsHiddenFace(const Picture& aovs, std::size_t pixel, const Renderer& renderer,
                            std::span<const Wardrobe> wardrobes) {
  if (aovs.character[pixel] == 0) return false;
  const Character& person = renderer.crowd().characters[aovs.character[pixel] - 1];
  const Wardrobe& wardrobe = wardrobes[person.wardrobe];
  if (aovs.region[pixel] > wardrobe.body.regions.size()) return false;
  const FaceId face(aovs.face[pixel] - 1);
  for (const ItemId item : renderer.crowd().combinations[person.combination].items) {
    if (wardrobe.items[item].visible[face] == 0) return true;
  }
  return false;
}

/// Whether a pixel of an AOV picture shows a garment's face that another item of its person hides.
inline bool showsHiddenGarment(const Picture& aovs, std::size_t pixel, const Renderer& renderer,
                               std::span<const Wardrobe> wardrobes) {
  const std::optional<GarmentPixel> shown = garmentAt(aovs, pixel, renderer, wardrobes);
  if (!shown) return false;
  const Character& person = renderer.crowd().characters[aovs.character[pixel] - 1];
  const Combination& worn = renderer.crowd().combinations[person.combination].items;
  const HiddenGarmentFaces hidden = hiddenInCombination(wardrobes[person.wardrobe], worn, shown->item);
  return !hidden.empty() && hidden[shown->face] != 0;
}

}  // namespace ensemble::testing
