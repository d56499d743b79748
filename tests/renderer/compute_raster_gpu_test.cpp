// The compute rasteriser against the graphics pipeline, and what must not change a picture.
#include "core/input_error.h"
#include "tests/renderer/gpu_fixture.h"
#include "tests/support/picture_difference.h"
#include "tests/support/small_sets.h"

namespace ensemble {
namespace {

using testing::countDifferences;
using testing::GpuTest;
using ::testing::HasSubstr;

class ComputeRasterTest : public GpuTest {
 protected:
  /// People in clothes without cut-outs, posed at key frames.
  static Scene crowdScene(RasterKind raster, std::uint32_t count = 100) {
    Scene scene = testing::tubeScene(count);
    scene.crowd.outfits = {{"tunic", 1.0f, {}}, {"patch", 1.0f, {}}};
    scene.output.width = 320;
    scene.output.height = 180;
    scene.output.samples = 1;
    scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
    scene.poses.snap_below = 1e5f;
    scene.raster = raster;
    return scene;
  }
  static View viewWithAovs(const Scene& scene) {
    View view = viewOf(scene);
    view.aovs = testing::allAovs();
    return view;
  }
};

class BothRasterisers : public ComputeRasterTest, public ::testing::WithParamInterface<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Samples, BothRasterisers, ::testing::Values(1u, 4u));

TEST_P(BothRasterisers, DrawTheSamePicture) {
  const std::vector<SceneCamera> cameras = {
      {.position = Vec3(0.4f, 4.0f, 9.0f), .target = Vec3(0.0f, 0.9f, 0.0f)},
      {.position = Vec3(0.0f, 12.0f, 40.0f), .target = Vec3(0.0f, 0.9f, 0.0f), .fov_y = radians(20.0f)},
      {.position = Vec3(0.5f, 1.2f, 0.3f), .target = Vec3(3.0f, 1.0f, 2.0f)},  // among them
  };
  // At key frames, and between them.
  for (std::size_t c = 0; c < 2 * cameras.size(); ++c) {
    std::array<Picture, 2> pictures;
    for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
      Scene scene = crowdScene(raster);
      scene.camera = cameras[c / 2];
      if (c % 2 == 1) scene.poses.snap_below = 0.0f;
      scene.output.samples = GetParam();
      pictures[raster == RasterKind::kCompute] = drawScene(scene, viewWithAovs(scene), 0.37);
    }
    const auto& [pipeline, compute] = pictures;
    EXPECT_EQ(pipeline.stats.characters_computed, 0u);
    EXPECT_GT(compute.stats.characters_computed, c / 2 == 2 ? 10u : 90u);
    EXPECT_EQ(compute.stats.poses.own > 0, c % 2 == 1);
    EXPECT_LE(compute.stats.characters_computed, compute.stats.characters_drawn);
    EXPECT_EQ(compute.stats.triangles(), pipeline.stats.triangles()) << c;
    const std::size_t people = testing::countPeoplePixels(pipeline);
    EXPECT_GT(people, 2000u);
    const auto most = static_cast<double>(people) * 0.002 + 5.0;
    EXPECT_LE(static_cast<double>(countDifferences(pipeline.color, compute.color)), most) << c;
    std::size_t others = 0, off = 0, faces = 0;
    for (std::size_t i = 0; i < pipeline.character.size(); ++i) {
      others += pipeline.character[i] != compute.character[i];
      if (pipeline.character[i] != compute.character[i] || pipeline.character[i] == 0) continue;
      faces += pipeline.face[i] != compute.face[i] || pipeline.region[i] != compute.region[i];
      off += std::abs(pipeline.depth[i] - compute.depth[i]) > 0.005f;
    }
    EXPECT_LE(static_cast<double>(others), most) << c;
    EXPECT_LE(static_cast<double>(faces), static_cast<double>(people) * 0.01 + 5.0) << c;
    EXPECT_LE(static_cast<double>(off), most) << c;
  }
}

TEST_F(ComputeRasterTest, CachesAndOrderChangeNoPixel) {
  Scene scene = crowdScene(RasterKind::kCompute);
  const auto renderer = makeRenderer(scene);
  scene.poses.cache_mib = 0;
  const auto without = makeRenderer(scene);
  const View view = viewWithAovs(scene);
  std::vector<Picture> in_order;
  for (int i = 0; i < 4; ++i) in_order.push_back(draw(*renderer, view, i / 30.0));
  EXPECT_NE(in_order[0].color.rgba, in_order[3].color.rgba);
  for (const int i : {3, 1, 0, 2}) {
    const Picture again = draw(*renderer, view, i / 30.0), anew = draw(*without, view, i / 30.0);
    EXPECT_EQ(again.stats.poses.skinned, 0u);
    EXPECT_GT(again.stats.poses.kept, 0u);
    EXPECT_EQ(again.stats.poses.skinned_vertices, 0u);
    EXPECT_EQ(anew.stats.poses.kept, 0u);
    EXPECT_GT(anew.stats.poses.skinned_vertices, 0u);
    for (const Picture* picture : {&again, &anew}) {
      EXPECT_EQ(picture->color.rgba, in_order[static_cast<std::size_t>(i)].color.rgba) << i;
      EXPECT_EQ(picture->face, in_order[static_cast<std::size_t>(i)].face) << i;
    }
  }
}

// From eye level nearer people hide most of the others; from above hardly anybody, and the ground shows
// everywhere.
TEST_P(BothRasterisers, LeaveOutWhatIsHiddenAndNothingElse) {
  const std::vector<SceneCamera> cameras = {
      {.position = Vec3(0.4f, 1.2f, 14.0f), .target = Vec3(0.0f, 0.9f, 0.0f), .fov_y = radians(30.0f)},
      {.position = Vec3(0.5f, 1.2f, 0.3f), .target = Vec3(3.0f, 1.0f, 2.0f)},  // among them
      {.position = Vec3(0.0f, 20.0f, 0.1f), .target = Vec3(0.0f, 0.0f, 0.0f)},
  };
  std::uint64_t hidden = 0;
  for (std::size_t c = 0; c < 2 * cameras.size(); ++c) {
    Scene scene = crowdScene(c % 2 == 0 ? RasterKind::kCompute : RasterKind::kAuto, 400);
    scene.camera = cameras[c / 2];
    scene.poses.snap_below = c % 2 == 0 ? 1e5f : 0.0f;
    scene.output.samples = GetParam();
    const auto renderer = makeRenderer(scene);
    View view = viewWithAovs(scene);
    for (const double seconds : {0.0, 0.37}) {
      view.occlusion = false;
      const Picture all = draw(*renderer, view, seconds);
      view.occlusion = true;
      const Picture left = draw(*renderer, view, seconds), again = draw(*renderer, view, seconds);
      EXPECT_EQ(all.stats.triangles_hidden, 0u);
      EXPECT_EQ(left.stats.triangles_computed + left.stats.triangles_hidden, all.stats.triangles_computed);
      EXPECT_EQ(left.stats.triangles_hidden, again.stats.triangles_hidden);
      View counted = view;
      counted.debug = DebugKind::kOverdraw;
      const Picture overdraw = draw(*renderer, counted, seconds);
      counted.occlusion = false;
      EXPECT_EQ(overdraw.color.rgba, draw(*renderer, counted, seconds).color.rgba) << "those behind as well";
      if (c / 2 == 0) hidden += left.stats.triangles_hidden;
      SCOPED_TRACE(c);
      testing::expectSamePixels(left, all);
    }
  }
  EXPECT_GT(hidden, 10000u);
}

// Behind a wall that the pipeline draws, and nobody who stands close before it.
TEST_P(BothRasterisers, LeaveOutWhomAWallHides) {
  Scene scene = crowdScene(RasterKind::kCompute, 200);
  scene.camera = {.position = Vec3(0.4f, 1.2f, 14.0f), .target = Vec3(0.0f, 0.9f, 0.0f)};
  scene.output.samples = GetParam();
  scene.environment.value = "memory";
  for (const auto& [z, low_x] : {std::pair{10.0f, 0.0f}, std::pair{0.0f, -30.0f}}) {
    SCOPED_TRACE(z);
    const EnvironmentMesh wall =
        buildEnvironmentMesh(testing::setOf({testing::wallAt(z, low_x, 30.0f, 20.0f)}), "wall.glb");
    Renderer renderer({.validate = testing::hasValidationLayer()});
    renderer.load(scene, wardrobes_, &wall);
    View view = viewWithAovs(scene);
    view.occlusion = false;
    const Picture all = draw(renderer, view, 0.37);
    view.occlusion = true;
    const Picture left = draw(renderer, view, 0.37);
    EXPECT_GT(left.stats.triangles_hidden, all.stats.triangles_computed / 4);
    EXPECT_GT(testing::countPeoplePixels(all), 500u);
    testing::expectSamePixels(left, all);
  }
}

// Each mesh in a buffer of its own, so that all that is sorted by buffers is.
TEST_F(ComputeRasterTest, ChunksOfBuffersGiveTheSamePicture) {
  const Scene scene = crowdScene(RasterKind::kCompute);
  const View view = viewWithAovs(scene);
  const Picture whole = drawScene(scene, view),
                chunked = drawScene(scene, view, 0.0, {.max_buffer_bytes = 20000});
  EXPECT_GT(whole.stats.characters_computed, 90u);
  EXPECT_EQ(whole.stats.characters_computed, chunked.stats.characters_computed);
  EXPECT_EQ(whole.color.rgba, chunked.color.rgba);
  EXPECT_EQ(whole.character, chunked.character);
  EXPECT_EQ(whole.face, chunked.face);
  EXPECT_EQ(whole.normal, chunked.normal);
}

// At equal depth the lower number wins, wherever the two stand in the queues.
TEST_F(ComputeRasterTest, OfTwoInOnePlaceTheFirstShows) {
  Scene scene = crowdScene(RasterKind::kCompute, 0);
  for (int i = 0; i < 6; ++i) {
    ScenePerson person;
    person.outfit.value = i % 2 == 0 ? "tunic" : "patch";
    person.phase = 0.3f;
    person.tint = 100 + static_cast<std::uint32_t>(i);
    scene.people.push_back(person);
  }
  scene.camera.position = Vec3(0.0f, 1.5f, 5.0f);
  const Picture picture = drawScene(scene, viewWithAovs(scene));
  EXPECT_EQ(picture.stats.characters_computed, 6u);
  std::set<std::uint32_t> seen(picture.character.begin(), picture.character.end());
  EXPECT_THAT(seen, ::testing::IsSubsetOf({0u, 1u, 2u})) << "the first in a tunic, the first with a patch";
  EXPECT_TRUE(seen.contains(1));
}

// Those who come near the camera are drawn by the graphics pipeline; the two meet by depth. The larger half
// is between key frames.
TEST_P(BothRasterisers, MeetByDepth) {
  std::array<Picture, 2> pictures;
  for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
    Scene scene = crowdScene(raster);
    scene.output.samples = GetParam();
    scene.camera = {.position = Vec3(0.5f, 1.2f, 0.3f), .target = Vec3(3.0f, 1.0f, 2.0f)};
    scene.poses.snap_below = 100.0f;
    pictures[raster == RasterKind::kCompute] = drawScene(scene, viewWithAovs(scene), 0.2);
  }
  const auto& [pipeline, compute] = pictures;
  EXPECT_GT(compute.stats.characters_computed, 10u);
  EXPECT_LT(compute.stats.characters_computed, compute.stats.characters_drawn);
  EXPECT_GT(compute.stats.poses.own, 5u);
  EXPECT_GT(compute.stats.poses.skinned, 5u);
  std::size_t others = 0;
  for (std::size_t i = 0; i < pipeline.character.size(); ++i)
    others += pipeline.character[i] != compute.character[i];
  EXPECT_LE(others, testing::countPeoplePixels(pipeline) / 500 + 5);
  EXPECT_LE(countDifferences(pipeline.color, compute.color), testing::countPeoplePixels(pipeline) / 500 + 5);
}

// One call, one time: people at keys in one view are between them in the next, and the other way round.
TEST_F(ComputeRasterTest, ViewsOfOneTimeDoNotDisturbEachOther) {
  const Scene scene = crowdScene(RasterKind::kCompute);
  const auto renderer = makeRenderer(scene);
  std::vector<View> views(3, viewWithAovs(scene));
  views[1].snap_below = 0.0f;
  std::vector<Picture> pictures(views.size());
  renderer->render(views, 0.37, pictures);
  EXPECT_EQ(pictures[0].color.rgba, pictures[2].color.rgba);
  EXPECT_NE(pictures[0].color.rgba, pictures[1].color.rgba);
  EXPECT_EQ(pictures[0].stats.poses.own, 0u);
  EXPECT_GT(pictures[1].stats.poses.own, 90u);
  EXPECT_EQ(draw(*renderer, views[1], 0.37).color.rgba, pictures[1].color.rgba);
}

// Hidden faces are drawn and cast no shadow; masks cut out of the picture and of the shadow.
TEST_P(BothRasterisers, DrawNaiveAndCutOuts) {
  for (const Technique technique : {Technique::kNaive, Technique::kTagged, Technique::kPrefitted}) {
    std::array<Picture, 2> pictures;
    for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
      Scene scene = crowdScene(raster);
      scene.technique = technique;
      scene.crowd.outfits = {};
      scene.output.samples = GetParam();
      scene.camera.position = Vec3(0.4f, 2.5f, 5.0f);
      pictures[raster == RasterKind::kCompute] = drawScene(scene, viewWithAovs(scene), 0.2);
    }
    const auto& [pipeline, compute] = pictures;
    EXPECT_GT(compute.stats.characters_computed, 60u);
    EXPECT_EQ(compute.stats.triangles(), pipeline.stats.triangles());
    const std::size_t people = testing::countPeoplePixels(pipeline);
    EXPECT_LE(countDifferences(pipeline.color, compute.color), people / 500 + 5) << toString(technique);
  }
}

TEST_F(ComputeRasterTest, TheDeviceTellsHowLongEachPartTakes) {
  for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
    const Scene scene = crowdScene(raster);
    const FrameStats stats = drawScene(scene, viewOf(scene)).stats;
    double sum = 0.0;
    for (const double part : stats.parts_ms) {
      EXPECT_GE(part, 0.0);
      sum += part;
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(sum, stats.frame_ms);
    const auto part = [&](FramePart of) { return stats.parts_ms[static_cast<std::size_t>(of)]; };
    EXPECT_GT(part(raster == RasterKind::kCompute ? FramePart::kRaster : FramePart::kPipeline), 0.0);
  }
}

TEST_F(ComputeRasterTest, SmallestPictureAndNobodyInSight) {
  Scene scene = crowdScene(RasterKind::kCompute);
  View view = viewWithAovs(scene);
  view.width = view.height = 1;
  const auto renderer = makeRenderer(scene);
  EXPECT_EQ(draw(*renderer, view).color.rgba.size(), 4u);
  view = viewWithAovs(scene);
  view.camera.target = view.camera.position + Vec3(0.0f, 5.0f, 5.0f);
  const Picture nobody = draw(*renderer, view);
  EXPECT_EQ(nobody.stats.characters_drawn, 0u);
  EXPECT_EQ(testing::countPeoplePixels(nobody), 0u);
}

TEST_F(ComputeRasterTest, WorkThatFitsNoBufferIsRefusedOrDrawnByThePipeline) {
  const RendererOptions small{.raster_work_bytes = 2000};
  Scene scene = crowdScene(RasterKind::kCompute, 60);
  try {
    drawScene(scene, viewOf(scene), 0.0, small);
    FAIL() << "no error";
  } catch (const SystemError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("needs more than the 2000 bytes that one buffer holds; use fewer people, or "
                          "set raster to auto"));
  }
  scene.raster = RasterKind::kAuto;
  const Picture automatic = drawScene(scene, viewWithAovs(scene), 0.0, small);
  scene.raster = RasterKind::kPipeline;
  EXPECT_EQ(automatic.stats.characters_computed, 0u);
  EXPECT_EQ(automatic.stats.poses.skinned_vertices, 0u) << "nobody's pose was made in vain";
  testing::expectSamePixels(automatic, drawScene(scene, viewWithAovs(scene), 0.0, small));
}

TEST_F(ComputeRasterTest, OneTileThatDoesNotFitLeavesThePictureToThePipeline) {
  Scene scene = crowdScene(RasterKind::kAuto, 60);
  RendererOptions options{.tiles = {.side = 64, .pixels = 64 * 64}};
  // The most that all tiles fit in, to a few hundred bytes; a little less, and one of them does not.
  std::uint64_t low = 0, high = 1u << 20;
  const auto computed = [&](std::uint64_t bytes) {
    options.raster_work_bytes = bytes;
    return drawScene(scene, viewOf(scene), 0.0, options).stats;
  };
  ASSERT_GT(computed(high).characters_computed, 0u);
  while (high - low > 256) {
    const std::uint64_t middle = (low + high) / 2;
    (computed(middle).characters_computed > 0 ? high : low) = middle;
  }
  const FrameStats refused = computed(low);
  EXPECT_EQ(refused.characters_computed, 0u);
  EXPECT_EQ(refused.triangles_computed, 0u) << "no tile was drawn by compute before the one that is refused";
  const Picture automatic = drawScene(scene, viewWithAovs(scene), 0.0, options);
  scene.raster = RasterKind::kPipeline;
  testing::expectSamePixels(automatic, drawScene(scene, viewWithAovs(scene), 0.0, options));
}

TEST_F(ComputeRasterTest, LargePicturesWithSeveralSamplesAreComputedInTiles) {
  Scene scene = crowdScene(RasterKind::kCompute);
  scene.output.width = scene.output.height = 3000;
  scene.output.samples = 4;
  const FrameStats stats = drawScene(scene, viewOf(scene)).stats;
  EXPECT_GT(stats.characters_computed, 30u);
}

}  // namespace
}  // namespace ensemble
