// A picture is a function of scene and time (design 8), whatever was drawn before or beside it.
#include "core/input_error.h"
#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;
using ::testing::HasSubstr;

TEST_F(GpuTest, AFrameIsTheSameAloneInOrderAndShuffled) {
  Scene scene = testing::tubeScene(10);
  scene.output.samples = 4;
  const View view = viewOf(scene);
  std::vector<Image8> in_order(6);
  const auto renderer = makeRenderer(scene);
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    in_order[i] = draw(*renderer, view, static_cast<double>(i) / 30.0).color;
    if (i > 0) {
      EXPECT_NE(in_order[i].rgba, in_order[i - 1].rgba) << "they move";
    }
  }
  for (const std::size_t i : {5u, 0u, 3u, 3u, 1u}) {
    EXPECT_EQ(draw(*renderer, view, static_cast<double>(i) / 30.0).color.rgba, in_order[i].rgba) << i;
  }
  EXPECT_EQ(drawScene(scene, view, 4 / 30.0).color.rgba, in_order[4].rgba);
}

TEST_F(GpuTest, TwoViewsInOneCallAreThoseOfTwoCalls) {
  const Scene scene = testing::tubeScene(10);
  std::vector<View> views(3, viewOf(scene));
  views[1].width = 96;
  views[1].samples = 4;
  views[1].camera.position = Vec3(-3.0f, 2.5f, 2.0f);
  views[1].background = BackgroundKind::kTransparent;
  views[2].aovs = testing::allAovs();
  views[2].camera.fov_y = 0.4f;
  const auto renderer = makeRenderer(scene);
  std::vector<Picture> together(views.size());
  renderer->render(views, 0.2, together);
  std::uint32_t posed = 0;
  for (const Picture& picture : together) posed += picture.stats.characters_posed;
  EXPECT_LE(posed, 2 * *scene.crowd.count)
      << "once as the clips run, once at a key frame for views from afar";
  EXPECT_GE(together[0].stats.characters_posed, together[0].stats.characters_drawn);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Picture alone = draw(*renderer, views[i], 0.2);
    EXPECT_EQ(alone.color.rgba, together[i].color.rgba) << i;
    EXPECT_EQ(alone.face, together[i].face) << i;
    EXPECT_EQ(alone.depth, together[i].depth) << i;
  }
}

TEST_F(GpuTest, ChunksOfBuffersGiveTheSamePicture) {
  Scene scene = testing::tubeScene(100);
  scene.raster = RasterKind::kPipeline;
  scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  const Picture whole = drawScene(scene, view);
  // 6 KB: some 40 people a chunk, one mesh a chunk, and the picture is read back in bands.
  const Picture chunked = drawScene(scene, view, 0.0, {.max_buffer_bytes = 6000});
  EXPECT_EQ(whole.color.rgba, chunked.color.rgba);
  EXPECT_EQ(whole.character, chunked.character);
  EXPECT_EQ(whole.face, chunked.face);
  EXPECT_EQ(whole.stats.triangles(), chunked.stats.triangles());
  EXPECT_GT(chunked.stats.drawCalls(), whole.stats.drawCalls());
}

TEST_F(GpuTest, WhatDoesNotFitIsAnErrorWithItsSize) {
  const Scene scene = testing::tubeScene(3);
  const auto renderer = makeRenderer(scene, {.memory_limit = 24u << 20});
  View view = viewOf(scene);
  view.width = view.height = 4000;
  view.samples = 4;
  Picture picture;
  try {
    renderer->render(std::span(&view, 1), 0.0, std::span(&picture, 1));
    FAIL() << "it can't fit";
  } catch (const SystemError& error) {
    EXPECT_THAT(error.what(), HasSubstr("MiB does not fit"));
    EXPECT_THAT(error.what(), HasSubstr("are left; use fewer people, smaller pictures or smaller textures"));
  }
  // What fits can still be drawn.
  EXPECT_EQ(draw(*renderer, viewOf(scene)).color.rgba, drawScene(scene, viewOf(scene)).color.rgba);
}

TEST_F(GpuTest, LoadingAgainReplacesTheScene) {
  const Scene first = testing::tubeScene(4);
  Scene second = testing::tubeScene(9);
  second.crowd.seed = 5;
  const auto renderer = makeRenderer(first);
  const Picture before = draw(*renderer, viewOf(first));
  renderer->load(second, wardrobes_);
  EXPECT_EQ(draw(*renderer, viewOf(second)).color.rgba, drawScene(second, viewOf(second)).color.rgba);
  renderer->load(first, wardrobes_);
  EXPECT_EQ(draw(*renderer, viewOf(first)).color.rgba, before.color.rgba);
}

TEST_F(GpuTest, NobodyIsAPictureToo) {
  const Scene scene = testing::tubeScene(0);
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  view.samples = 4;
  const Picture picture = draw(*makeRenderer(scene), view);
  EXPECT_EQ(testing::countPeoplePixels(picture), 0u);
  EXPECT_EQ(picture.stats.drawCalls(), 0u);
  EXPECT_EQ(picture.stats.characters_drawn, 0u);
  EXPECT_EQ(picture.stats.vertexInvocations(), 0u);
  // Blue sky above, ground below.
  const auto pixel = [&](std::uint32_t x, std::uint32_t y) {
    return picture.color.rgba.data() + 4 * (y * view.width + x);
  };
  EXPECT_GT(pixel(80, 0)[2], pixel(80, 0)[0] + 10);
  EXPECT_LE(pixel(80, 119)[2], pixel(80, 119)[0]);
}

TEST_F(GpuTest, PeopleOutOfSightAreNotDrawnAndChangeNothing) {
  Scene scene = testing::tubeScene(0);
  const auto person = [](Vec3 position) {
    ScenePerson someone;
    someone.outfit.value = "tunic";
    someone.position = position;
    someone.tint = 5u;
    return someone;
  };
  scene.people = {person(Vec3(0.0f))};
  const View view = viewOf(scene);
  const Picture alone = drawScene(scene, view);
  scene.people.push_back(person(Vec3(0.0f, 0.0f, 40.0f)));  // behind the camera
  scene.people.push_back(person(Vec3(60.0f, 0.0f, -10.0f)));
  const Picture crowded = drawScene(scene, view);
  EXPECT_EQ(crowded.stats.characters_drawn, 1u);
  EXPECT_EQ(crowded.stats.characters_posed, 1u);
  EXPECT_EQ(crowded.color.rgba, alone.color.rgba);
}

}  // namespace
}  // namespace ensemble
