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

FaceSightings sightings(const TemplateBody& body, const Item& item, const HiddenFaceOptions& options = {}) {
  const Item* worn = &item;
  return findSightings(body, std::span(&worn, 1), options);
}

std::size_t countHidden(const FaceSightings& found) {
  return static_cast<std::size_t>(
      std::count(found.first_pose.begin(), found.first_pose.end(), FaceSightings::kNever));
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

TEST(HiddenFaces, WithoutClothesEverythingShows) {
  EXPECT_EQ(countHidden(sightings(tubeBody(), Item())), 0u);
}

TEST(HiddenFaces, ClothAllAroundHidesAllOfTheBody) {
  EXPECT_EQ(countHidden(sightings(tubeBody(), closedSleeve(0.205f))), std::size_t{kTubeFaces});
}

TEST(HiddenFaces, WhatLooksOutOfAnOpeningIsKept) {
  const TemplateBody body = tubeBody();
  const FaceSightings found = sightings(body, sleeve(0.205f, 0.3f, 1.5f));
  for (std::uint32_t f = 0; f < kTubeFaces; ++f) {
    const auto [low, high] = heights(body, FaceId(f));
    const bool is_seen = found.first_pose[FaceId(f)] != FaceSightings::kNever;
    if (high < 0.31f || low > 1.49f) {
      EXPECT_TRUE(is_seen) << low << " to " << high;
    } else if (low > 0.74f && high < 1.06f) {
      EXPECT_FALSE(is_seen) << low << " to " << high;
    }
  }
}

TEST(HiddenFaces, SkinThatPokesThroughIsHiddenWithinTheTolerance) {
  const TemplateBody body = tubeBody();
  EXPECT_EQ(countHidden(sightings(body, closedSleeve(0.195f))), std::size_t{kTubeFaces});
  EXPECT_EQ(countHidden(sightings(body, closedSleeve(0.195f), {.tolerance = 0.0f})), 0u);
  EXPECT_EQ(countHidden(sightings(body, closedSleeve(0.185f))), 0u) << "15 mm under the skin";
}

TEST(HiddenFaces, WhatAMaskMayCutOutOrTheRendererDoesNotDrawHidesNothing) {
  const TemplateBody body = tubeBody();
  RawMaterial mask = clothMaterial("cloth.net");
  mask.alpha_mode = AlphaMode::kMask;
  EXPECT_EQ(countHidden(sightings(body, closedSleeve(0.205f, mask))), 0u);

  Item inside_out = closedSleeve(0.205f);
  for (Triangle& face : inside_out.garments[0].parts[0].faces) std::swap(face[1], face[2]);
  EXPECT_EQ(countHidden(sightings(body, inside_out)), std::size_t{kTubeFaces}) << "double-sided";
  inside_out.materials[0].double_sided = false;
  EXPECT_EQ(countHidden(sightings(body, inside_out)), 0u) << "its back is not drawn";
}

TEST(HiddenFaces, APoseMayShowWhatAnotherHides) {
  const TemplateBody body = tubeBody();
  Item stiff = closedSleeve(0.205f);
  for (RawVertex& vertex : stiff.garments[0].parts[0].vertices) {
    vertex.skin = {};
    vertex.skin.weights[0] = 1.0f;  // it does not sway with the body
  }
  const FaceSightings found = sightings(body, stiff);
  EXPECT_LT(countHidden(found), std::size_t{kTubeFaces});
  for (const std::uint32_t pose : found.first_pose) {
    if (pose == FaceSightings::kNever) continue;
    ASSERT_LT(pose, found.poses.size());
    EXPECT_GT(found.poses[pose].key, 0.0f) << "in the first pose the body stands upright inside";
  }
  TemplateBody still = body;
  still.clips.clear();
  EXPECT_EQ(countHidden(sightings(still, stiff)), std::size_t{kTubeFaces});
}

TEST(HiddenFaces, TheNumberOfThreadsChangesNothing) {
  const TemplateBody body = tubeBody();
  const Item item = sleeve(0.21f, 0.6f, 1.2f);
  const FaceSightings one = sightings(body, item, {.jobs = 1}), four = sightings(body, item, {.jobs = 4});
  EXPECT_TRUE(std::equal(one.first_pose.begin(), one.first_pose.end(), four.first_pose.begin()));
}

TEST(RayScene, TellsWhatStandsInTheWay) {
  const TemplateBody body = tubeBody();
  const RayDevice device;
  const std::vector<Mat4> rest = skinningMatrices(body.skeleton, restPose(body.skeleton));
  const Item item = sleeve(0.195f, 0.6f, 1.2f);
  const Item* worn = &item;
  const RayScene scene(device, body, std::span(&worn, 1), rest);
  const Triangle& corners = body.faces[FaceId(100)];
  Vec3 a = scene.body()[corners[0]], b = scene.body()[corners[1]], c = scene.body()[corners[2]];
  const Vec3 normal = glm::normalize(glm::cross(b - a, c - a)), middle = (a + b + c) / 3.0f;
  EXPECT_TRUE(scene.isSeen(middle, normal, 100, {}));
  EXPECT_FALSE(scene.isSeen(middle, -normal, 100, {})) << "the far side of the body";
  EXPECT_NEAR(scene.depthOfCloth(middle, normal, 100, 0.01f), 0.005f * std::cos(kPi / 8), 2e-4f);
  EXPECT_EQ(scene.depthOfCloth(middle, normal, 100, 0.004f), std::numeric_limits<float>::infinity());
  const std::vector<std::uint8_t> all_gone(kTubeFaces, 1);
  EXPECT_FALSE(scene.isSeen(middle, -normal, 100, all_gone)) << "the far side of the cloth";
  const RayScene bare(device, body, {}, rest);
  EXPECT_TRUE(bare.isSeen(middle, -normal, 100, all_gone));
}

}  // namespace
}  // namespace ensemble
