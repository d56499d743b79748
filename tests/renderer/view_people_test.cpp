// Who is posed at a key frame and who is rasterised in compute: rules of sizes and counts, held against
// geometry.
#include "renderer/view_people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "renderer/posed_extents.h"
#include "renderer/raster_people.h"
#include "tests/renderer/test_wardrobe.h"

namespace ensemble {
namespace {

View smallView() {
  View view;
  view.width = 640;
  view.height = 360;
  view.camera = {
      .position = Vec3(0.5f, 1.6f, 3.0f), .target = Vec3(0.0f, 1.0f, 0.0f), .fov_y = radians(50.0f)};
  return view;
}

Vec3 randomPoint(std::mt19937& random, float reach) {
  std::uniform_real_distribution<float> at(-reach, reach);
  return {at(random), at(random), at(random)};
}

/// Sub-pixels of a world point.
glm::dvec3 onScreen(const ScreenRows& rows, const Vec3& p) {
  const glm::dvec4 point(p, 1.0);
  return {glm::dot(rows.x, point), glm::dot(rows.y, point), glm::dot(rows.z, point)};
}

TEST(RasterPeople, RowsLeadWhereTheCameraDoes) {
  const View view = smallView();
  const Tile tile{100, 40, 300, 200};
  const ScreenRows rows = cameraRows(view, tile);
  const Mat4 clip = clipFromWorld(view);
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = randomPoint(random, 2.0f) - Vec3(0.0f, 0.0f, 3.0f);
    const Vec4 c = clip * Vec4(p, 1.0f);
    const glm::dvec3 at = onScreen(rows, p);
    EXPECT_NEAR(at.x / at.z / 256.0, (c.x / c.w * 0.5 + 0.5) * 640.0 - 100.5, 1e-3);
    EXPECT_NEAR(at.y / at.z / 256.0, (c.y / c.w * 0.5 + 0.5) * 360.0 - 40.5, 1e-3);
    EXPECT_NEAR(at.z, c.w, 1e-5);
  }
}

TEST(RasterPeople, KeptPositionsComeOutInTheWorld) {
  GpuCharacter character{};
  character.world_from_model[0] = {0.0f, 0.0f, 2.0f, 5.0f};
  character.world_from_model[1] = {0.0f, 2.0f, 0.0f, 1.0f};
  character.world_from_model[2] = {-2.0f, 0.0f, 0.0f, -3.0f};
  const KeptBox box{Vec3(-1.0f, -0.5f, -1.0f), 0.001f};
  const View view = smallView();
  const ScreenRows rows = cameraRows(view, wholeOf(view));
  const GpuRasterPerson person = makeRasterPerson(rows, character.world_from_model, box);
  const Vec4 kept(700.0f, 1200.0f, 300.0f, 1.0f);
  const Vec3 model(-0.3f, 0.7f, -0.7f),
      world(2.0f * model.z + 5.0f, 2.0f * model.y + 1.0f, -2.0f * model.x - 3.0f);
  const glm::dvec3 screen = onScreen(rows, world);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(glm::dot(person.world_from_kept[i], kept), world[i], 1e-5f);
    EXPECT_NEAR(glm::dot(person.screen_from_kept[i], kept), screen[i], 1e-4 * std::abs(screen[i]) + 1e-4);
  }
}

// Whoever fits has no triangle with an extent that would overflow: random edges in random balls.
TEST(RasterPeople, WhoFitsTheCameraHasSmallTriangles) {
  const View view = smallView();
  const ScreenRows rows = cameraRows(view, wholeOf(view));
  const CameraFrame frame = cameraFrame(view.camera);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> radius(0.2f, 2.0f), length(0.01f, 1.0f);
  int fitting = 0;
  double greatest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const Sphere bounds{view.camera.position + randomPoint(random, 6.0f), radius(random)};
    const float edge = length(random);
    if (!fitsCamera(view, bounds, edge)) continue;
    ++fitting;
    Vec3 a = randomPoint(random, 1.0f), b = randomPoint(random, 1.0f);
    a = bounds.center + a * (bounds.radius / std::max(1.0f, glm::length(a)));
    b = a + glm::normalize(b) * edge;
    if (glm::distance(b, bounds.center) > bounds.radius) continue;
    EXPECT_GT(glm::dot(a - view.camera.position, frame.forward), view.camera.near_plane);
    const glm::dvec3 p = onScreen(rows, a), q = onScreen(rows, b);
    const double reach = std::max(std::abs(p.x / p.z - q.x / q.z), std::abs(p.y / p.z - q.y / q.z));
    greatest = std::max(greatest, reach);
    EXPECT_LT(reach, 32767.0);
  }
  EXPECT_GT(fitting, 500);
  EXPECT_GT(greatest, 8000.0) << "the rule is not far too careful";
}

TEST(RasterPeople, ASizeOnTheScreenIsThatOfAMeasureThere) {
  View view = smallView();
  view.camera = {.position = Vec3(0.0f), .target = Vec3(0.0f, 0.0f, -1.0f), .fov_y = radians(90.0f)};
  // 20 metres fill 360 pixels.
  view.snap_below = 36.01f;
  EXPECT_TRUE(smallPeopleOf(view).hold(Vec3(0.0f, -1.0f, -10.0f), 2.0f));
  view.snap_below = 35.99f;
  EXPECT_FALSE(smallPeopleOf(view).hold(Vec3(0.0f, -1.0f, -10.0f), 2.0f));
}

TEST(KeyFrames, TheNearestKeyOfTheClipThatWeighsMore) {
  const std::vector<Wardrobe> wardrobes = {testing::tubeWardrobe()};
  const Animation animation = buildAnimation(wardrobes);
  const KeyFrames frames = numberKeyFrames(animation);
  ASSERT_GE(animation.clips.size(), 1u);
  ASSERT_GT(animation.clips[0].key_count, 2u);
  std::size_t keys = 0;
  for (const GpuClip& clip : animation.clips) keys += clip.key_count;
  EXPECT_EQ(frames.keys.size(), keys);
  EXPECT_EQ(frames.firstOfWardrobe(0), 0u);
  EXPECT_EQ(frames.firstOfWardrobe(1), keys);
  GpuCharacter character{};
  const float interval = 1.0f / static_cast<float>(animation.clips[0].key_count - 1);
  character.phase = 1.4f * interval;
  EXPECT_EQ(nearestKey(frames, character), 1u);
  character.phase = 1.6f * interval;
  EXPECT_EQ(nearestKey(frames, character), 2u);
  character.phase = 0.99999f;
  EXPECT_EQ(nearestKey(frames, character), animation.clips[0].key_count - 1);
  character.idle_weight = 0.6f;
  character.idle_phase = 0.0f;
  EXPECT_EQ(nearestKey(frames, character), 0u);
  for (const KeyFrame& key : frames.keys) {
    const KeptBox& box = frames.boxes[key.clip];
    const Sphere& bounds = animation.bounds[key.clip];
    EXPECT_LE(box.low.x, bounds.center.x - bounds.radius + 1e-5f);
    EXPECT_GE(box.low.x + box.step * 32767.0f, bounds.center.x + bounds.radius - 1e-4f);
  }
}

TEST(KeyFrames, BetweenWhichKeysSomebodyIs) {
  const std::vector<Wardrobe> wardrobes = {testing::tubeWardrobe()};
  const KeyFrames frames = numberKeyFrames(buildAnimation(wardrobes));
  const std::uint32_t last = frames.clips[0].key_count - 1;
  GpuCharacter character{};
  character.phase = 1.25f / static_cast<float>(last);
  std::optional<BetweenKeys> keys = betweenKeys(frames, character);
  ASSERT_TRUE(keys);
  EXPECT_EQ(keys->before, 1u);
  EXPECT_EQ(keys->after, 2u);
  EXPECT_NEAR(keys->part, 0.25f, 1e-4f);
  character.phase = 1.0f;  // the last key closes the loop
  keys = betweenKeys(frames, character);
  ASSERT_TRUE(keys);
  EXPECT_EQ(keys->after, last);
  EXPECT_NEAR(keys->part, 1.0f, 1e-5f);
  character.idle_weight = 0.5f;
  EXPECT_FALSE(betweenKeys(frames, character)) << "two clips";
  character.idle_weight = 0.0f;
  character.feet[1].w = 1.0f;
  EXPECT_FALSE(betweenKeys(frames, character)) << "a foot is held";
}

TEST(PosedExtents, AreThoseOfThePosedMeshes) {
  const Wardrobe wardrobe = testing::tubeWardrobe();
  const std::vector<Wardrobe> wardrobes = {wardrobe};
  const Animation animation = buildAnimation(wardrobes);
  const std::vector<Combination> combinations = {{}};
  const SubMeshLists lists = buildSubMeshLists(wardrobe, combinations, Technique::kTagged);
  const PosedExtents extents = posedExtents(lists, animation, 0, 5);
  ASSERT_EQ(extents.clip_count, animation.clips.size());
  ASSERT_EQ(extents.longest_edges.size(), lists.meshes.size() * extents.clip_count);
  ASSERT_EQ(extents.run_boxes.size(), lists.index_lists.size());
  // The bare body's, straight from the template and its clips.
  for (std::size_t c = 0; c < wardrobe.body.clips.size(); ++c) {
    const Clip& clip = wardrobe.body.clips[c];
    float most = 0.0f;
    Box box;
    for (std::uint32_t key = 0; key < clip.key_count; ++key) {
      const std::vector<Mat4> matrices = skinningMatrices(wardrobe.body.skeleton, clip.key(key));
      for (const auto& vertex : wardrobe.body.vertices) box.add(skinPosition(vertex, matrices));
      for (const Triangle& face : wardrobe.body.faces) {
        for (std::size_t k = 0; k < 3; ++k) {
          most = std::max(
              most,
              glm::distance(skinPosition(wardrobe.body.vertices[VertexId(face[k])], matrices),
                            skinPosition(wardrobe.body.vertices[VertexId(face[(k + 1) % 3])], matrices)));
        }
      }
    }
    EXPECT_GT(most, 0.01f);
    EXPECT_NEAR(extents.longest_edges[c], most, 1e-4f);
    Box of_runs;
    for (std::size_t l = 0; l < lists.index_lists.size(); ++l) {
      const std::size_t runs = (lists.index_lists[IndexListId(l)].indices.size() / 3 + 4) / 5;
      ASSERT_EQ(extents.run_boxes[l].size(), runs * extents.clip_count);
      for (std::size_t run = 0; run < runs; ++run) {
        const Box& own = extents.run_boxes[l][run * extents.clip_count + c];
        of_runs.low = glm::min(of_runs.low, own.low);
        of_runs.high = glm::max(of_runs.high, own.high);
        EXPECT_LT(own.extent().y, 0.9f * box.extent().y) << "a few triangles";
      }
    }
    EXPECT_LT(glm::distance(of_runs.low, box.low), 1e-4f);
    EXPECT_LT(glm::distance(of_runs.high, box.high), 1e-4f);
  }
}

/// A row of people into the distance, all alike.
struct Row {
  std::vector<GpuCharacter> characters;
  std::vector<Sphere> bounds;
  std::vector<float> heights, edges;
  std::vector<std::uint32_t> all;
  explicit Row(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      GpuCharacter& character = characters.emplace_back();
      character.world_from_model[2].w = -1.0f - 0.5f * static_cast<float>(i);
      bounds.push_back({Vec3(0.0f, 1.0f, character.world_from_model[2].w), 1.0f});
      heights.push_back(1.7f);
      edges.push_back(0.05f);
      all.push_back(i);
    }
  }
  PeopleAtTime people() const { return {characters, bounds, heights, edges}; }
};

class ViewPeopleTest : public ::testing::Test {
 protected:
  std::size_t computed(const View& view, const Row& row, std::size_t most = 1000000) {
    shown_.choose(view, fitShadowMap(view, row.bounds), frames_, row.people(), row.all, row.all, most);
    std::size_t count = 0;
    for (const std::uint32_t p : row.all) count += shown_.isComputed(p);
    return count;
  }
  const std::vector<Wardrobe> wardrobes_ = {testing::tubeWardrobe()};
  const KeyFrames frames_ = numberKeyFrames(buildAnimation(wardrobes_));
  ViewPeople shown_;
};

TEST_F(ViewPeopleTest, SmallPeopleSnapAndOthersAreComputedToo) {
  View view = smallView();
  view.snap_below = 40.0f;
  view.raster = RasterKind::kCompute;
  const Row row(200);
  EXPECT_GT(computed(view, row), 190u);
  std::size_t exact = 0;
  const SmallPeople small = smallPeopleOf(view);
  for (const std::uint32_t p : row.all) {
    const bool is_small = small.hold(row.bounds[p].center - Vec3(0.0f, 1.0f, 0.0f), 1.7f);
    EXPECT_EQ(shown_.key(p) != ViewPeople::kExact, is_small) << p;
    exact += !is_small && shown_.isComputed(p);
  }
  EXPECT_GT(exact, 20u);
  view.raster = RasterKind::kPipeline;
  EXPECT_EQ(computed(view, row), 0u);
  EXPECT_NE(shown_.key(199), ViewPeople::kExact) << "poses don't depend on the rasteriser";
}

TEST_F(ViewPeopleTest, AutoLeavesSmallCrowdsToThePipeline) {
  View view = smallView();
  view.snap_below = 1000.0f;
  EXPECT_EQ(computed(view, Row(15)), 0u);
  EXPECT_GT(computed(view, Row(120)), 100u);
  EXPECT_EQ(computed(view, Row(120), 0), 0u) << "a device that can't";
  view.raster = RasterKind::kCompute;
  EXPECT_GT(computed(view, Row(15)), 10u);
  EXPECT_EQ(computed(view, Row(40), 20), 20u) << "no more than ids can tell apart";
}

// A leg that is bent to hold its foot lengthens edges, but only in poses of one's own.
TEST_F(ViewPeopleTest, WhoHoldsItsFeetNeedsMoreRoom) {
  View view = smallView();
  view.camera.position.z = 1.0f;
  view.raster = RasterKind::kCompute;
  Row row(100);
  const auto count = [&](float snap_below, float holds) {
    view.snap_below = snap_below;
    for (GpuCharacter& character : row.characters) character.feet[0].w = holds;
    return computed(view, row);
  };
  EXPECT_EQ(count(1000.0f, 1.0f), count(1000.0f, 0.0f));
  EXPECT_EQ(count(0.0f, 0.0f), count(1000.0f, 0.0f));
  EXPECT_LT(count(0.0f, 1.0f), count(0.0f, 0.0f));
  EXPECT_GT(count(0.0f, 1.0f), 80u);
}

TEST_F(ViewPeopleTest, WhoseTrianglesGetTooLargeIsNotComputed) {
  View view = smallView();
  view.snap_below = 1000.0f;
  view.raster = RasterKind::kCompute;
  Row row(100);
  row.edges[60] = 50.0f;
  computed(view, row);
  EXPECT_FALSE(shown_.isComputed(60));
  EXPECT_TRUE(shown_.isComputed(70));
  EXPECT_TRUE(shown_.castsComputed(70));
}

}  // namespace
}  // namespace ensemble
