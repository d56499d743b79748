// Hidden faces found with rays, on a tube of a person in sleeves of cloth.
#include "assetpipe/hidden_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "assetpipe/ray_scene.h"
#include "tests/renderer/test_wardrobe.h"

namespace ensemble {
namespace {

using namespace testing;

/// A band of cloth around the tube, whose own radius is 0.2 and height 1.8 metres. Its rings are the tube's,
/// so that it bends as the tube does.
Item sleeve(float radius, float bottom, float top,
            const RawMaterial& material = clothMaterial("cloth.sleeve")) {
  Item item;
  item.name = "sleeve";
  item.materials.push_back(material);
  const int rings = static_cast<int>(std::lround((top - bottom) / 0.15f));
  item.garments.push_back({"garment.sleeve", {tubeBand(0, radius, bottom, top, rings)}});
  return item;
}

/// The same with lids, so that nothing looks out of its ends.
Item closedSleeve(float radius, const RawMaterial& material = clothMaterial("cloth.sleeve")) {
  Item item = sleeve(radius, -0.9f, 2.7f, material);
  RawPrimitive& band = item.garments[0].parts[0];
  const auto ring_count = static_cast<std::uint32_t>(band.vertices.size() / kTubeSegments);
  for (const std::uint32_t ring : {0u, ring_count - 1}) {
    const std::uint32_t first = ring * kTubeSegments,
                        center = static_cast<std::uint32_t>(band.vertices.size());
    band.vertices.push_back(band.vertices[first]);
    band.vertices.back().position.x = band.vertices.back().position.z = 0.0f;
    for (std::uint32_t s = 0; s < kTubeSegments; ++s) {
      const std::uint32_t a = first + s, b = first + (s + 1) % kTubeSegments;
      band.faces.push_back(ring == 0 ? Triangle{center, b, a} : Triangle{center, a, b});
    }
  }
  return item;
}

FaceHoles holes(const TemplateBody& body, const Item& item, const HiddenFaceOptions& options = {}) {
  const Item* worn = &item;
  return findHoles(body, std::span(&worn, 1), options);
}

std::size_t countHidden(const FaceHoles& found) {
  return static_cast<std::size_t>(std::count_if(found.faces.begin(), found.faces.end(),
                                                [](const FaceHole& face) { return !face.is_kept; }));
}

/// Heights of a face at rest.
std::pair<float, float> heights(const TemplateBody& body, FaceId face) {
  float low = 10.0f, high = -10.0f;
  for (const std::uint32_t v : body.faces[face]) {
    low = std::min(low, body.vertices[VertexId(v)].position.y);
    high = std::max(high, body.vertices[VertexId(v)].position.y);
  }
  return {low, high};
}

TEST(HiddenFaces, WithoutClothesEverythingShows) { EXPECT_EQ(countHidden(holes(tubeBody(), Item())), 0u); }

TEST(HiddenFaces, ClothAllAroundHidesAllOfTheBody) {
  EXPECT_EQ(countHidden(holes(tubeBody(), closedSleeve(0.205f))), std::size_t{kTubeFaces});
}

TEST(HiddenFaces, WhatLooksOutOfAnOpeningIsKept) {
  const TemplateBody body = tubeBody();
  const FaceHoles found = holes(body, sleeve(0.205f, 0.3f, 1.5f));
  for (std::uint32_t f = 0; f < kTubeFaces; ++f) {
    const auto [low, high] = heights(body, FaceId(f));
    const bool is_seen = found.faces[FaceId(f)].is_kept;
    if (high < 0.31f || low > 1.49f) {
      EXPECT_TRUE(is_seen) << low << " to " << high;
    } else if (low > 0.74f && high < 1.06f) {
      EXPECT_FALSE(is_seen) << low << " to " << high;
    }
  }
}

TEST(HiddenFaces, SkinThatPokesThroughIsHiddenWithinTheTolerance) {
  const TemplateBody body = tubeBody();
  EXPECT_EQ(countHidden(holes(body, closedSleeve(0.195f))), std::size_t{kTubeFaces});
  EXPECT_EQ(countHidden(holes(body, closedSleeve(0.195f), {.tolerance = 0.0f})), 0u);
  EXPECT_EQ(countHidden(holes(body, closedSleeve(0.185f))), 0u) << "15 mm under the skin";
}

// A bare tube shows all of itself: every hole is the face. On average over all sides a picture shows a
// quarter of a surface, but the tube's far parts bend away and hide no part of it.
TEST(HiddenFaces, TheHoleOfABareFaceIsTheFace) {
  TemplateBody body = tubeBody();
  body.clips.clear();
  const FaceHoles found = holes(body, Item());
  for (std::uint32_t f = 0; f < kTubeFaces; ++f) {
    const Triangle& corners = body.faces[FaceId(f)];
    const auto at = [&](std::size_t i) { return body.vertices[VertexId(corners[i])].position; };
    const float area = 0.5f * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    EXPECT_NEAR(found.faces[FaceId(f)].share, 1.0f, 0.03f);
    EXPECT_NEAR(found.faces[FaceId(f)].area, 0.25f * area, 0.01f * area);
  }
}

TEST(HiddenFaces, HowLargeAHoleMayBeIsForTheCallerToSay) {
  const TemplateBody body = tubeBody();
  const Item item = sleeve(0.21f, 0.3f, 1.5f);
  const auto hidden = [&](float share, float area) {
    return countHidden(holes(body, item, {.hole_share = share, .hole_area = area, .patch = 0}));
  };
  const HiddenFaceOptions usually;
  const std::size_t strict = hidden(0.0f, 0.0f), usual = hidden(usually.hole_share, usually.hole_area),
                    lax = hidden(0.9f, 1.0f);
  EXPECT_GT(strict, 0u);
  EXPECT_LT(strict, usual);
  EXPECT_LT(usual, lax);
}

// A patch of cloth is cut out of a closed sleeve, before the middle of one face, or nothing but a patch is
// there.
TEST(HiddenFaces, AFewFacesGoWithThoseAround) {
  TemplateBody body = tubeBody();
  body.clips.clear();
  Item open = closedSleeve(0.205f);
  std::vector<Triangle>& cloth = open.garments[0].parts[0].faces;
  const auto isBefore = [&](const Triangle& face, float size) {
    Vec3 middle(0.0f);
    for (const std::uint32_t v : face) middle += open.garments[0].parts[0].vertices[v].position / 3.0f;
    return middle.z > 0.1f && std::abs(middle.x) < 0.1f && std::abs(middle.y - 0.9f) < size;
  };
  const auto keptFaces = [&](const HiddenFaceOptions& options) {
    return std::size_t{kTubeFaces} - countHidden(holes(body, open, options));
  };
  std::erase_if(cloth, [&](const Triangle& face) { return isBefore(face, 0.1f); });
  // What shows through the opening shows plainly: it stays, few faces as it is.
  EXPECT_GT(keptFaces({}), 0u);
  // Where nothing is plain the same faces go with those around them.
  const HiddenFaceOptions lax{.hole_share = 0.6f, .hole_area = 1.0f, .patch = 100};
  const HiddenFaceOptions strict{.hole_share = 0.6f, .hole_area = 1.0f, .patch = 0};
  EXPECT_GT(keptFaces(strict), 0u);
  EXPECT_EQ(keptFaces(lax), 0u);
}

TEST(HiddenFaces, WhatAMaskMayCutOutOrTheRendererDoesNotDrawHidesNothing) {
  const TemplateBody body = tubeBody();
  RawMaterial mask = clothMaterial("cloth.net");
  mask.alpha_mode = AlphaMode::kMask;
  EXPECT_EQ(countHidden(holes(body, closedSleeve(0.205f, mask))), 0u);

  Item inside_out = closedSleeve(0.205f);
  for (Triangle& face : inside_out.garments[0].parts[0].faces) std::swap(face[1], face[2]);
  EXPECT_EQ(countHidden(holes(body, inside_out)), std::size_t{kTubeFaces}) << "double-sided";
  inside_out.materials[0].double_sided = false;
  EXPECT_EQ(countHidden(holes(body, inside_out)), 0u) << "its back is not drawn";
}

TEST(HiddenFaces, APoseMayShowWhatAnotherHides) {
  const TemplateBody body = tubeBody();
  Item stiff = closedSleeve(0.205f);
  for (RawVertex& vertex : stiff.garments[0].parts[0].vertices) {
    vertex.skin = {};
    vertex.skin.weights[0] = 1.0f;  // it does not sway with the body
  }
  const FaceHoles found = holes(body, stiff, {.patch = 0});
  EXPECT_LT(countHidden(found), std::size_t{kTubeFaces});
  for (const FaceHole& face : found.faces) {
    if (!face.is_kept) continue;
    ASSERT_LT(face.pose, found.poses.size());
    EXPECT_GT(found.poses[face.pose].key, 0.0f) << "in the first pose the body stands upright inside";
  }
  TemplateBody still = body;
  still.clips.clear();
  EXPECT_EQ(countHidden(holes(still, stiff)), std::size_t{kTubeFaces});
}

TEST(HiddenFaces, TheNumberOfThreadsChangesNothing) {
  const TemplateBody body = tubeBody();
  const Item item = sleeve(0.21f, 0.6f, 1.2f);
  const FaceHoles one = holes(body, item, {.jobs = 1}), four = holes(body, item, {.jobs = 4});
  EXPECT_TRUE(std::equal(one.faces.begin(), one.faces.end(), four.faces.begin()));
}

TEST(RayScene, TellsWhatStandsInTheWay) {
  const TemplateBody body = tubeBody();
  const RayDevice device;
  const std::vector<Mat4> rest = skinningMatrices(body.skeleton, restPose(body.skeleton));
  const Item item = sleeve(0.195f, 0.6f, 1.2f);
  const Item* worn = &item;
  const RayScene scene(device, surfaceOf(body), {.body = nullptr, .items = std::span(&worn, 1)}, rest);
  const Triangle& corners = body.faces[FaceId(100)];
  Vec3 a = scene.vertices()[corners[0]], b = scene.vertices()[corners[1]], c = scene.vertices()[corners[2]];
  const Vec3 normal = glm::normalize(glm::cross(b - a, c - a)), middle = (a + b + c) / 3.0f;
  EXPECT_TRUE(scene.isSeen(middle, normal, 100));
  EXPECT_FALSE(scene.isSeen(middle, -normal, 100)) << "the far side of body and cloth";
  EXPECT_TRUE(scene.hasClothUnder(middle, normal, 0.006f)) << "5 mm under it";
  EXPECT_FALSE(scene.hasClothUnder(middle, normal, 0.004f));
  EXPECT_FALSE(scene.hasClothUnder(middle, normal, 0.0f));
  EXPECT_FALSE(scene.hasClothUnder(middle, -normal, 0.5f)) << "one looks into the far side of the sleeve";
  const RayScene bare(device, surfaceOf(body), {}, rest);
  EXPECT_FALSE(bare.hasClothUnder(middle, normal, 1.0f));
  EXPECT_FALSE(bare.isSeen(middle, -normal, 100)) << "the far side of the body, seen from outside";
}

}  // namespace
}  // namespace ensemble
