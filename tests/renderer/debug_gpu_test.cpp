// `debug`: pictures that tell how they were drawn, by both rasterisers.
#include <set>

#include "renderer/debug_overlay.h"
#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;

class DebugPictures : public GpuTest {
 protected:
  static Scene crowdScene(RasterKind raster, std::uint32_t samples = 1) {
    Scene scene = testing::tubeScene(100);
    scene.output.width = 320;
    scene.output.height = 180;
    scene.output.samples = samples;
    scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
    scene.poses.snap_below = 1e5f;
    scene.raster = raster;
    return scene;
  }
  static View debugView(const Scene& scene, DebugKind debug) {
    View view = viewOf(scene);
    view.debug = debug;
    return view;
  }
};

OverlayColor colorAt(const Picture& picture, std::size_t pixel) {
  const std::uint8_t* rgb = picture.color.rgba.data() + 4 * pixel;
  return {rgb[0], rgb[1], rgb[2]};
}

bool isGrey(const OverlayColor& color) { return color[0] == color[1] && color[1] == color[2]; }

/// Whether a colour is a tint over some grey (tintPeople).
bool isTinted(const OverlayColor& color, const OverlayColor& tint) {
  for (int grey = 0; grey < 256; ++grey) {
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) all = all && color[k] == (2 * tint[k] + grey) / 3;
    if (all) return true;
  }
  return false;
}

TEST_F(DebugPictures, LeaveOtherPicturesAndAovsAsTheyAre) {
  const Scene scene = crowdScene(RasterKind::kCompute);
  const auto renderer = makeRenderer(scene);
  const Picture before = draw(*renderer, viewOf(scene));
  for (const DebugKind debug : {DebugKind::kRasteriser, DebugKind::kPose, DebugKind::kOverdraw}) {
    View view = debugView(scene, debug);
    const Picture debugged = draw(*renderer, view);
    EXPECT_NE(debugged.color.rgba, before.color.rgba);
    EXPECT_TRUE(debugged.character.empty()) << "nobody asked for it";
    EXPECT_EQ(debugged.stats.triangles(), before.stats.triangles());
    view.aovs.add(Aov::kCharacter);
    view.aovs.add(Aov::kDepth);
    const Picture with_aovs = draw(*renderer, view);
    EXPECT_EQ(with_aovs.color.rgba, debugged.color.rgba);
    EXPECT_EQ(with_aovs.character.size(), std::size_t{320} * 180);
    EXPECT_EQ(with_aovs.depth.size(), std::size_t{320} * 180);
  }
  EXPECT_EQ(draw(*renderer, viewOf(scene)).color.rgba, before.color.rgba);
}

TEST_F(DebugPictures, RasteriserTellsWhoDrewWhom) {
  for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
    const Scene scene = crowdScene(raster);
    View view = debugView(scene, DebugKind::kRasteriser);
    view.aovs.add(Aov::kCharacter);
    const Picture picture = drawScene(scene, view);
    const bool computed = raster == RasterKind::kCompute;
    ASSERT_EQ(picture.stats.characters_computed, computed ? picture.stats.characters_drawn : 0u);
    std::size_t people = 0;
    for (std::size_t i = 0; i < picture.character.size(); ++i) {
      const OverlayColor color = colorAt(picture, i);
      if (picture.character[i] == 0) {
        ASSERT_TRUE(isGrey(color)) << i;
      } else {
        ++people;
        ASSERT_TRUE(isTinted(color, colorOfRasteriser(computed))) << i;
      }
    }
    EXPECT_GT(people, 2000u);
  }
}

TEST_F(DebugPictures, PoseTellsKeyFramesFromOwnPoses) {
  Scene scene = crowdScene(RasterKind::kPipeline);
  for (const bool snaps : {true, false}) {
    scene.poses.snap_below = snaps ? 1e5f : 0.0f;
    View view = debugView(scene, DebugKind::kPose);
    view.aovs.add(Aov::kCharacter);
    const Picture picture = drawScene(scene, view);
    std::size_t people = 0, exact = 0;
    for (std::size_t i = 0; i < picture.character.size(); ++i) {
      if (picture.character[i] == 0) continue;
      ++people;
      exact += isTinted(colorAt(picture, i), colorOfPose(ViewPeople::kExact));
    }
    EXPECT_GT(people, 2000u);
    EXPECT_EQ(exact, snaps ? 0u : people);
  }
}

TEST_F(DebugPictures, OverdrawIsTheSameByBothRasterisers) {
  std::vector<Picture> pictures;
  for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
    const Scene scene = crowdScene(raster);
    View view = debugView(scene, DebugKind::kOverdraw);
    view.aovs.add(Aov::kCharacter);
    pictures.push_back(drawScene(scene, view));
  }
  const Picture &pipeline = pictures[0], &compute = pictures[1];
  ASSERT_EQ(compute.stats.characters_computed, compute.stats.characters_drawn);
  std::size_t covered = 0, differing = 0, beside = 0;
  std::set<OverlayColor> colors;
  for (std::size_t i = 0; i < pipeline.character.size(); ++i) {
    const OverlayColor color = colorAt(pipeline, i);
    differing += color != colorAt(compute, i);
    if (pipeline.character[i] == 0) {
      beside += !isGrey(color);
    } else {
      ++covered;
      colors.insert(color);
      ASSERT_FALSE(isGrey(color)) << i;
    }
  }
  EXPECT_GT(covered, 2000u);
  EXPECT_EQ(beside, 0u);
  EXPECT_GE(colors.size(), 4u) << "people stand behind one another";
  EXPECT_EQ(colors.count(colorOfOverdraw(1)), 1u);
  // Coverage of single triangles may differ where an edge comes near a pixel's centre.
  EXPECT_LE(static_cast<double>(differing), 0.01 * static_cast<double>(covered));
}

TEST_F(DebugPictures, OverdrawOfAllSamplesIsThatOfOne) {
  std::vector<Picture> pictures;
  for (const std::uint32_t samples : {1u, 4u}) {
    const Scene scene = crowdScene(RasterKind::kAuto, samples);
    View view = debugView(scene, DebugKind::kOverdraw);
    view.background = BackgroundKind::kTransparent;
    view.aovs.add(Aov::kCharacter);
    pictures.push_back(drawScene(scene, view));
  }
  for (std::size_t i = 0; i < pictures[0].character.size(); ++i) {
    if (pictures[0].character[i] == 0) continue;
    ASSERT_EQ(colorAt(pictures[0], i), colorAt(pictures[1], i)) << i;
  }
}

// The queues and counts of each tile are its own.
TEST_F(DebugPictures, TilesGiveTheSameCounts) {
  Scene scene = crowdScene(RasterKind::kAuto);
  for (const DebugKind debug : {DebugKind::kRasteriser, DebugKind::kPose, DebugKind::kOverdraw}) {
    const View view = debugView(scene, debug);
    const Picture whole = drawScene(scene, view);
    const Picture tiled = drawScene(scene, view, 0.0, {.tiles = {.side = 128, .pixels = 128 * 64}});
    std::size_t differing = 0;
    for (std::size_t i = 0; i < std::size_t{320} * 180; ++i)
      differing += colorAt(whole, i) != colorAt(tiled, i);
    EXPECT_LE(differing, 60u) << "where a tile begins decides how coordinates round";
  }
}

}  // namespace
}  // namespace ensemble
