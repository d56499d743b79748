// Pictures drawn tile by tile.
#include "renderer/view_setup.h"
#include "tests/renderer/gpu_fixture.h"

#include "core/input_error.h"

namespace ensemble {
namespace {

using testing::GpuTest;

/// 160 x 120 pixels as 3 x 2 tiles of 54 x 60.
constexpr TileLimits kSmallTiles{.side = 64, .pixels = 64 * 64};

class TilesTest : public GpuTest {
 protected:
  static Scene crowdedScene() {
    Scene scene = testing::tubeScene(100);
    scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
    return scene;
  }
  static View fullView(const Scene& scene) {
    View view = viewOf(scene);
    view.samples = 4;
    view.linear = true;
    view.aovs = testing::allAovs();
    return view;
  }
};

// Coordinates round differently where a tile begins, so that an edge falls by 1/256 of a pixel to the
// other side here and there. What is computed from the pixel alone is the same to the last bit.
TEST_F(TilesTest, ShowWhatThePictureDrawnAtOnceShows) {
  const Scene scene = crowdedScene();
  const View view = fullView(scene);
  const Picture whole = drawScene(scene, view);
  const Picture tiled = drawScene(scene, view, 0.0, {.tiles = kSmallTiles});
  ASSERT_GT(testing::countPeoplePixels(whole), 1500u);
  std::size_t sky_pixels = 0, others = 0;
  for (std::size_t i = 0; i < whole.character.size(); ++i) {
    others += whole.character[i] != tiled.character[i] || whole.face[i] != tiled.face[i];
    if (whole.face[i] == tiled.face[i]) {
      EXPECT_NEAR(tiled.depth[i], whole.depth[i], 1e-3f * whole.depth[i]);
    }
    if (whole.depth[i] != 0.0f) continue;
    ++sky_pixels;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) EXPECT_EQ(tiled.color.rgba[k], whole.color.rgba[k]) << k;
  }
  EXPECT_GT(sky_pixels, 1000u);
  EXPECT_LE(others, 4u) << "of 19,200";
  EXPECT_LE(testing::differingPixels(whole.color, tiled.color).size(), 20u);
}

// Where tiles lie follows from the picture's size, so that no limit of the device moves a bit.
TEST_F(TilesTest, AreTheSameWhateverMemoryThereIs) {
  const Scene scene = crowdedScene();
  View view = fullView(scene);
  const RendererOptions ample{.tiles = kSmallTiles};
  testing::expectSamePixels(drawScene(scene, view, 0.0, {.max_buffer_bytes = 6000, .tiles = kSmallTiles}),
                            drawScene(scene, view, 0.0, ample));
  // Drawn at once this view would take some 130 bytes a pixel: 60 MB.
  view.width = 800;
  view.height = 600;
  const TileLimits tiles{.side = 256, .pixels = 256 * 128};
  testing::expectSamePixels(drawScene(scene, view, 0.0, {.memory_limit = 32u << 20, .tiles = tiles}),
                            drawScene(scene, view, 0.0, {.tiles = tiles}));
  EXPECT_THROW(drawScene(scene, view, 0.0, {.memory_limit = 32u << 20}), SystemError);
}

TEST_F(TilesTest, AreMadeByThemselvesOfALargePicture) {
  const Scene scene = crowdedScene();
  View view = fullView(scene);
  view.width = 4098;
  view.height = 60;
  view.samples = 1;
  const Picture wide = drawScene(scene, view);
  EXPECT_GT(testing::countPeoplePixels(wide), 100u);
  EXPECT_EQ(wide.color.rgba.size(), 4u * 4098 * 60);
  testing::expectSamePixels(wide,
                            drawScene(scene, view, 0.0, {.tiles = {.side = 2049, .pixels = 2049 * 60}}));
}

TEST_F(TilesTest, HaveTheirDrawsCounted) {
  Scene scene = crowdedScene();
  scene.crowd.outfits = {{"tunic", 1.0f, {}}};  // So that people have the same triangles.
  scene.raster = RasterKind::kPipeline;
  const View view = fullView(scene);
  const auto renderer = makeRenderer(scene);
  const FrameStats whole = draw(*renderer, view).stats;
  const auto tiled_renderer = makeRenderer(scene, {.tiles = kSmallTiles});
  const FrameStats tiled = draw(*tiled_renderer, view).stats;
  EXPECT_EQ(tiled.characters_drawn, whole.characters_drawn);
  EXPECT_EQ(tiled.characters_posed, whole.characters_posed);
  EXPECT_EQ(tiled.gpu_mesh_bytes, whole.gpu_mesh_bytes);
  EXPECT_EQ(tiled.shadow.triangles, whole.shadow.triangles) << "one shadow map serves all tiles";
  EXPECT_EQ(tiled.shadow.draw_calls, whole.shadow.draw_calls);
  EXPECT_EQ(tiled.shadow.vertex_invocations, whole.shadow.vertex_invocations);
  EXPECT_GT(tiled.main.draw_calls, whole.main.draw_calls);
  ASSERT_EQ(whole.main.triangles % whole.characters_drawn, 0u);
  const std::uint64_t per_person = whole.main.triangles / whole.characters_drawn;
  EXPECT_EQ(tiled.main.triangles % per_person, 0u);
  EXPECT_GT(tiled.main.triangles, whole.main.triangles) << "who stands on a border is drawn twice";
  EXPECT_LT(tiled.main.triangles, 6 * whole.main.triangles) << "but nobody in every tile";
  if (!renderer->countsVertexInvocations()) return;
  EXPECT_GT(*tiled.main.vertex_invocations, *whole.main.vertex_invocations);
  EXPECT_LT(*tiled.main.vertex_invocations, 6 * *whole.main.vertex_invocations);
}

TEST_F(TilesTest, BeginAfreshForEachView) {
  const Scene scene = crowdedScene();
  std::vector<View> views(3, fullView(scene));
  views[1].camera.position = Vec3(-3.0f, 2.5f, 4.0f);
  views[1].light.direction = Vec3(0.6f, -1.0f, 0.2f);
  views[2].background = BackgroundKind::kTransparent;
  const auto renderer = makeRenderer(scene, {.tiles = kSmallTiles});
  std::vector<Picture> together(views.size());
  renderer->render(views, 0.3, together);
  for (std::size_t i = 0; i < views.size(); ++i) {
    testing::expectSamePixels(together[i], drawScene(scene, views[i], 0.3, {.tiles = kSmallTiles}));
  }
}

TEST_F(TilesTest, WhatNoViewportHoldsIsRefused) {
  const Scene scene = testing::tubeScene(3);
  const auto renderer = makeRenderer(scene);
  View view = viewOf(scene);
  view.width = 1u << 20;
  view.height = 1;
  Picture picture;
  try {
    renderer->render(std::span(&view, 1), 0.0, std::span(&picture, 1));
    FAIL() << "no device is as large";
  } catch (const SystemError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("a picture of 1048576 x 1 pixels is larger than the "));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(" that it can place; make the picture smaller"));
  }
}

}  // namespace
}  // namespace ensemble
