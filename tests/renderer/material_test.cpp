// Textures' levels, tints, and clips as the renderer plays them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "renderer/animation.h"
#include "renderer/garment_parts.h"
#include "renderer/mip_chain.h"
#include "renderer/tints.h"
#include "tests/renderer/test_wardrobe.h"

namespace ensemble {
namespace {

using ::testing::ElementsAre;

Image8 plainImage(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> color) {
  Image8 image{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = color[i % 4];
  return image;
}

TEST(MipChain, APlainImageStaysPlainAtEverySize) {
  for (const auto& [width, height] : {std::pair{3u, 7u}, {16u, 16u}, {100u, 2u}}) {
    const auto levels = mipChain(plainImage(width, height, {10, 128, 255, 77}), 16);
    ASSERT_EQ(levels.size(), 5u);
    for (std::size_t level = 0; level < levels.size(); ++level) {
      EXPECT_EQ(levels[level].size(), 4u * (16u >> level) * (16u >> level));
      for (std::size_t i = 0; i < levels[level].size(); i += 4) {
        EXPECT_THAT(std::vector<int>(levels[level].begin() + i, levels[level].begin() + i + 4),
                    ElementsAre(10, 128, 255, 77));
      }
    }
  }
}

TEST(MipChain, AveragesInLinearLight) {
  Image8 image = plainImage(2, 2, {0, 0, 0, 255});
  std::fill_n(image.rgba.begin(), 8, std::uint8_t{255});  // the upper two are white
  const auto levels = mipChain(image, 2);
  EXPECT_THAT(levels[1], ElementsAre(188, 188, 188, 255)) << "half the light is sRGB 188";
}

TEST(MipChain, TransparentTexelsLendNoColour) {
  Image8 image = plainImage(2, 2, {0, 255, 0, 0});
  std::copy_n(std::vector<std::uint8_t>{200, 0, 0, 255}.begin(), 4, image.rgba.begin());
  const auto levels = mipChain(image, 2);
  EXPECT_THAT(levels[1], ElementsAre(200, 0, 0, 64));
  EXPECT_NEAR(meanColor(image).y, 0.0f, 1e-6f);
  EXPECT_NEAR(meanColor(image).x, 0.5776f, 1e-3f);
}

TEST(MipChain, ShrinksByArea) {
  Image8 image = plainImage(3, 1, {0, 0, 0, 255});
  for (int i = 0; i < 3; ++i) image.rgba[i] = 255;  // one of three columns
  const auto levels = mipChain(image, 1);
  EXPECT_THAT(levels[0], ElementsAre(156, 156, 156, 255)) << "a third of the light";
}

TEST(Tints, KindsFollowNames) {
  EXPECT_EQ(tintKindOf("head", true), TintKind::kSkin);
  EXPECT_EQ(tintKindOf("Eyes", true), TintKind::kNone);
  EXPECT_EQ(tintKindOf("teeth", true), TintKind::kNone);
  EXPECT_EQ(tintKindOf("eyebrow", true), TintKind::kHair);
  EXPECT_EQ(tintKindOf("hair.bob02", false), TintKind::kHair);
  EXPECT_EQ(tintKindOf("cloth.shoes01", false), TintKind::kShoes);
  EXPECT_EQ(tintKindOf("cloth.casual01", false), TintKind::kCloth);
  EXPECT_EQ(tintKindOf("fixed.shoes.sole", false), TintKind::kNone);
  EXPECT_EQ(tintKindOf("fixedcloth", false), TintKind::kCloth);
}

TEST(Tints, RangesCoverTheTableOnce) {
  std::uint32_t next = 0;
  for (const TintKind kind : {TintKind::kSkin, TintKind::kHair, TintKind::kShoes, TintKind::kCloth}) {
    const TintRange range = tintRange(kind);
    EXPECT_EQ(range.first, next);
    EXPECT_GT(range.count, 5u);
    next += range.count;
  }
  EXPECT_EQ(next, tintTable().size());
  EXPECT_EQ(tintRange(TintKind::kNone).count, 0u);
  for (const Vec4& color : tintTable()) {
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(color[i] > 0.0f && color[i] < 1.0f);
  }
}

TEST(Tints, SkinIsOneColourAndGarmentsAreNot) {
  EXPECT_EQ(tintKey(TintKind::kSkin, "head"), tintKey(TintKind::kSkin, "hands"));
  EXPECT_NE(tintKey(TintKind::kCloth, "shirt"), tintKey(TintKind::kCloth, "trousers"));
  EXPECT_NE(tintKey(TintKind::kSkin, ""), tintKey(TintKind::kHair, ""));
}

/// Bands of a tube one above the other, as one mesh.
std::vector<std::uint8_t> partsOfBands(std::span<const std::array<float, 2>> bands) {
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const auto& [bottom, top] : bands) {
    const RawPrimitive band = testing::tubeBand(0, 0.2f + 0.01f * bottom, bottom, top, 3);
    for (const Triangle& face : band.faces) {
      for (const std::uint32_t corner : face)
        indices.push_back(corner + static_cast<std::uint32_t>(vertices.size()));
    }
    for (const RawVertex& vertex : band.vertices) vertices.push_back(packVertex(vertex));
  }
  const std::vector<std::uint8_t> per_vertex = garmentParts(vertices, indices);
  std::vector<std::uint8_t> per_band;
  const std::size_t band_size = vertices.size() / bands.size();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (i % band_size == 0) per_band.push_back(per_vertex[i]);
    EXPECT_EQ(per_vertex[i], per_band.back()) << "a band is of one part";
  }
  return per_band;
}

TEST(GarmentParts, AShirtAndTrousersAreTwoAndABeltIsOfTheTrousers) {
  const std::vector<std::array<float, 2>> bands = {
      {0.1f, 0.99f}, {0.88f, 1.5f}, {0.81f, 0.86f}, {0.9f, 1.3f}};
  EXPECT_THAT(partsOfBands(bands), ElementsAre(1, 0, 1, 0));
}

TEST(GarmentParts, TooManyShareTheLastNumber) {
  std::vector<std::array<float, 2>> bands;
  for (int i = 0; i < 10; ++i)
    bands.push_back({1.0f - 0.1f * static_cast<float>(i), 1.05f - 0.1f * static_cast<float>(i)});
  EXPECT_THAT(partsOfBands(bands), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 7, 7));
}

TEST(PhaseAt, WrapsInBothDirectionsAndAfterDays) {
  EXPECT_FLOAT_EQ(phaseAt(0.0, 2.0f, 0.25f, 1.0f), 0.25f);
  EXPECT_FLOAT_EQ(phaseAt(1.0, 2.0f, 0.25f, 1.0f), 0.75f);
  EXPECT_FLOAT_EQ(phaseAt(2.0, 2.0f, 0.25f, 1.0f), 0.25f);
  EXPECT_FLOAT_EQ(phaseAt(1.0, 2.0f, 0.25f, -1.0f), 0.75f);
  EXPECT_FLOAT_EQ(phaseAt(3.0, 2.0f, 0.25f, 0.0f), 0.25f);
  EXPECT_FLOAT_EQ(phaseAt(30.0 * 86400.0 + 0.5, 1.0f, 0.25f, 1.0f), 0.75f);
  EXPECT_EQ(phaseAt(5.0, 0.0f, 0.25f, 1.0f), 0.0f) << "a clip of one key";
  EXPECT_EQ(phaseAt(-1e-12, 1.0f, 0.0f, 1.0f), 0.0f) << "never 1";
}

TEST(Animation, HoldsEveryKeyAndItsFixedJoint) {
  Wardrobe wardrobe = testing::tubeWardrobe();
  Wardrobe still = wardrobe;
  still.body.clips.clear();
  const std::vector<Wardrobe> wardrobes = {std::move(wardrobe), std::move(still)};
  const Animation animation = buildAnimation(wardrobes);
  EXPECT_THAT(animation.first_clip, ElementsAre(0u, 1u));
  EXPECT_THAT(animation.joint_count, ElementsAre(3u, 3u));
  ASSERT_EQ(animation.clips.size(), 2u);
  EXPECT_EQ(animation.clips[1].key_count, 1u);
  EXPECT_EQ(animation.seconds[1], 0.0f);
  const Clip& clip = wardrobes[0].body.clips[0];
  ASSERT_EQ(animation.clips[0].key_count, clip.key_count);
  EXPECT_EQ(animation.texels.size(), 3u * 3u * (clip.key_count + 1u));
  const std::vector<Mat4> matrices = skinningMatrices(wardrobes[0].body.skeleton, clip.key(2));
  const vec4* rows = animation.texels.data() + 3 * (2 * 3 + 1);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) EXPECT_EQ(rows[row][column], matrices[1][column][row]);
  }
  EXPECT_EQ(animation.texels[3 * (2 * 3 + 2)], vec4(1, 0, 0, 0)) << "the joint that never moves";
}

TEST(Animation, BoundsHoldEveryVertexAtEveryTime) {
  const std::vector<Wardrobe> wardrobes = {testing::tubeWardrobe()};
  const Animation animation = buildAnimation(wardrobes);
  const TemplateBody& body = wardrobes[0].body;
  const Sphere& bounds = animation.bounds[0];
  for (std::uint32_t key = 0; key < body.clips[0].key_count; ++key) {
    const std::vector<Mat4> matrices = skinningMatrices(body.skeleton, body.clips[0].key(key));
    for (const RawVertex& vertex : body.vertices) {
      EXPECT_LE(glm::length(skinPosition(vertex, matrices) - bounds.center), bounds.radius * 1.0001f);
    }
  }
  EXPECT_LT(bounds.radius, 1.6f) << "not wastefully large";
}

}  // namespace
}  // namespace ensemble
