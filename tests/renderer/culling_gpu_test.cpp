// Pictures and counts of `culling: device` and `host` are the same; who decides when.
#include "tests/renderer/gpu_fixture.h"
#include "tests/support/small_sets.h"

namespace ensemble {
namespace {

using testing::GpuTest;

class CullingTest : public GpuTest {
 protected:
  static Scene crowdScene(CullingKind culling, std::uint32_t count = 150) {
    Scene scene = testing::tubeScene(count);
    scene.output.width = 240;
    scene.output.height = 160;
    scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
    scene.raster = RasterKind::kPipeline;
    scene.culling = culling;
    scene.poses.snap_below = 25.0f;
    return scene;
  }
  static View fullView(const Scene& scene) {
    View view = viewOf(scene);
    view.linear = true;
    view.aovs = testing::allAovs();
    return view;
  }
  static void expectSamePass(const PassStats& a, const PassStats& b) {
    EXPECT_EQ(a.draw_calls, b.draw_calls);
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.vertex_invocations, b.vertex_invocations);
  }
  static void expectSame(const Picture& a, const Picture& b) {
    testing::expectSamePixels(a, b);
    EXPECT_EQ(a.stats.characters_drawn, b.stats.characters_drawn);
    EXPECT_EQ(a.stats.characters_posed, b.stats.characters_posed);
    EXPECT_EQ(a.stats.people_triangles, b.stats.people_triangles);
    expectSamePass(a.stats.main, b.stats.main);
    expectSamePass(a.stats.shadow, b.stats.shadow);
    expectSamePass(a.stats.environment, b.stats.environment);
  }
  /// Draws a scene both ways. @return the device's
  Picture expectSameBothWays(Scene scene, double seconds, const RendererOptions& options = {}) {
    scene.culling = CullingKind::kHost;
    const Picture host = drawScene(scene, fullView(scene), seconds, options);
    scene.culling = CullingKind::kDevice;
    Picture device = drawScene(scene, fullView(scene), seconds, options);
    EXPECT_FALSE(host.stats.culled_on_device);
    EXPECT_TRUE(device.stats.culled_on_device);
    expectSame(host, device);
    return device;
  }
};

TEST_F(CullingTest, GivesTheSamePictureOverCameras) {
  const std::vector<SceneCamera> cameras = {
      {.position = Vec3(0.4f, 4.0f, 9.0f), .target = Vec3(0.0f, 0.9f, 0.0f)},
      {.position = Vec3(0.0f, 12.0f, 40.0f), .target = Vec3(0.0f, 0.9f, 0.0f), .fov_y = radians(20.0f)},
      {.position = Vec3(0.5f, 1.2f, 0.3f), .target = Vec3(3.0f, 1.0f, 2.0f)},      // among them
      {.position = Vec3(0.0f, 30.0f, 0.0f), .target = Vec3(0.0f, 60.0f, -1.0f)}};  // into the sky
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    Scene scene = crowdScene(CullingKind::kDevice);
    scene.camera = cameras[c];
    scene.output.samples = c % 2 == 0 ? 4 : 1;
    const Picture picture = expectSameBothWays(scene, 0.37);
    if (c < 3) {
      EXPECT_GT(testing::countPeoplePixels(picture), 2000u);
      EXPECT_GT(picture.stats.characters_posed, 20u);
    } else {
      EXPECT_EQ(picture.stats.characters_drawn, 0u);
      EXPECT_EQ(picture.stats.main.draw_calls, 0u);
    }
  }
}

TEST_F(CullingTest, GivesTheSamePictureInEveryTechnique) {
  for (const Technique technique : kAllTechniques) {
    Scene scene = crowdScene(CullingKind::kDevice);
    scene.technique = technique;
    expectSameBothWays(scene, 0.1);
    expectSameBothWays(scene, 0.1, {.max_buffer_bytes = 12000});  // several chunks of people
  }
}

TEST_F(CullingTest, GivesTheSamePictureTileByTile) {
  const RendererOptions tiles{.tiles = {.side = 64, .pixels = 64 * 64}};
  const Picture picture = expectSameBothWays(crowdScene(CullingKind::kDevice), 0.2, tiles);
  EXPECT_GT(testing::countPeoplePixels(picture), 2000u);
}

TEST_F(CullingTest, GivesTheSamePictureOfASet) {
  const EnvironmentMesh set = buildEnvironmentMesh(
      testing::setOf({testing::floorAt(0.0f, 10.0f), testing::wallAt(-2.0f, -3.0f, 3.0f, 3.0f)}), "set.glb");
  std::array<Picture, 2> pictures;
  for (const CullingKind culling : {CullingKind::kHost, CullingKind::kDevice}) {
    const Scene scene = crowdScene(culling);
    Renderer renderer({.validate = testing::hasValidationLayer()});
    renderer.load(scene, wardrobes_, &set);
    pictures[culling == CullingKind::kDevice] = draw(renderer, fullView(scene));
  }
  EXPECT_GT(pictures[1].stats.environment.draw_calls, 0u);
  expectSame(pictures[0], pictures[1]);
}

// One call, one time: what one way has posed the other does not take for its own.
TEST_F(CullingTest, BothWaysMeetInOneCall) {
  const Scene scene = crowdScene(CullingKind::kDevice);
  std::vector<View> views(6, fullView(scene));
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].culling = i % 3 == 1 ? CullingKind::kHost : CullingKind::kDevice;
    if (i % 2 == 1) views[i].snap_below = 1e5f;
  }
  const auto renderer = makeRenderer(scene);
  std::vector<Picture> pictures(views.size());
  renderer->render(views, 0.37, pictures);
  EXPECT_THAT(renderer->validationMessages(), ::testing::IsEmpty());
  EXPECT_NE(pictures[0].color.rgba, pictures[1].color.rgba);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_EQ(pictures[i].stats.culled_on_device, i % 3 != 1);
    EXPECT_EQ(pictures[i].color.rgba, pictures[i % 2].color.rgba) << i;
    EXPECT_EQ(pictures[i].character, pictures[i % 2].character) << i;
  }
  EXPECT_EQ(draw(*renderer, views[4], 0.37).color.rgba, pictures[0].color.rgba);
}

TEST_F(CullingTest, IsTheHostsWhereTheHostPlans) {
  const Scene scene = crowdScene(CullingKind::kDevice);
  const auto renderer = makeRenderer(scene);
  const auto is_on_device = [&](const View& view) { return draw(*renderer, view).stats.culled_on_device; };
  View view = viewOf(scene);
  EXPECT_TRUE(is_on_device(view));
  view.coverage = true;
  EXPECT_FALSE(is_on_device(view));
  view = viewOf(scene);
  for (const DebugKind debug : {DebugKind::kRasteriser, DebugKind::kPose, DebugKind::kOverdraw}) {
    view.debug = debug;
    EXPECT_FALSE(is_on_device(view));
  }
  view = viewOf(scene);
  view.culling = CullingKind::kAuto;
  EXPECT_EQ(is_on_device(view), !renderer->isOnCpu());
  view.culling = CullingKind::kHost;
  EXPECT_FALSE(is_on_device(view));
}

TEST_F(CullingTest, IsTheHostsWhereComputeMayDraw) {
  for (const std::uint32_t count : {15u, 40u}) {
    for (const RasterKind raster : kAllRasterKinds) {
      Scene scene = crowdScene(CullingKind::kDevice, count);
      scene.raster = raster;
      const Picture picture = drawScene(scene, viewOf(scene));
      const bool may_compute = raster == RasterKind::kCompute || (raster == RasterKind::kAuto && count == 40);
      EXPECT_EQ(picture.stats.culled_on_device, !may_compute) << toString(raster) << ' ' << count;
      EXPECT_EQ(picture.stats.characters_computed > 0, may_compute);
    }
  }
}

TEST_F(CullingTest, IsAPartOfTheFramesTime) {
  const Scene scene = crowdScene(CullingKind::kDevice);
  const FrameStats device = drawScene(scene, viewOf(scene)).stats;
  EXPECT_GT(device.parts_ms[static_cast<std::size_t>(FramePart::kCulling)], 0.0);
}

}  // namespace
}  // namespace ensemble
