// People who walk, turn and stand: the device poses them as posed_joints.h does on the host.
#include "core/gait.h"
#include "renderer/posed_joints.h"
#include "tests/renderer/gpu_fixture.h"
#include "tests/renderer/pixel_ray.h"
#include "tests/support/stick_walker.h"

namespace ensemble {
namespace {

using testing::GpuTest;

class WalkerGpuTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    wardrobes_ = {testing::stickWardrobe()};
    scene_.file = "scene.yaml";
    scene_.wardrobes.push_back({"", "memory", {}});
    scene_.crowd.count = 6;
    scene_.crowd.scale = {0.9f, 1.1f};
    ScenePlacement& placement = scene_.crowd.placement;
    placement.kind = PlacementKind::kPaths;
    ScenePath path;
    path.points = {{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-3, 0, 3}};
    path.closed = true;
    path.corner_radius = 1.5f;
    path.stops = {{7.0f, 1.0f}};
    placement.paths = {path};
    placement.spacing = 0.5f;
    scene_.camera.position = Vec3(0.0f, 3.0f, 8.0f);
    scene_.camera.target = Vec3(0.0f, 0.5f, 0.0f);
    scene_.output.width = 320;
    scene_.output.height = 200;
    scene_.output.samples = 1;
  }

  Scene scene_;
};

class WalkersByRasteriser : public WalkerGpuTest, public ::testing::WithParamInterface<RasterKind> {};
INSTANTIATE_TEST_SUITE_P(Rasterisers, WalkersByRasteriser,
                         ::testing::Values(RasterKind::kPipeline, RasterKind::kCompute));

TEST_P(WalkersByRasteriser, PoseThemAsTheHostDoes) {
  scene_.raster = GetParam();
  // Compute keeps positions in steps of a tenth of a millimetre: much for a thin triangle.
  const float most_outside = GetParam() == RasterKind::kCompute ? 0.03f : 0.01f;
  View view = viewOf(scene_);
  view.aovs = testing::allAovs();
  view.ground = false;
  const auto renderer = makeRenderer(scene_);
  const TemplateBody& body = wardrobes_[0].body;
  const std::optional<Legs> legs = findLegs(body.skeleton);
  ASSERT_TRUE(legs);
  std::size_t leg_pixels = 0, blended = 0;
  for (double seconds = 0.0; seconds < 20.0; seconds += 1.7) {
    view.snap_below = seconds > 10.0 ? 1e5f : 0.0f;
    const Picture picture = draw(*renderer, view, seconds);
    EXPECT_EQ(picture.stats.characters_computed,
              GetParam() == RasterKind::kCompute ? picture.stats.characters_drawn : 0u);
    for (std::uint32_t pixel = 0; pixel < picture.character.size(); ++pixel) {
      if (picture.character[pixel] == 0) continue;
      const Character& person = renderer->crowd().characters.at(picture.character[pixel] - 1);
      CharacterPose pose = poseAt(renderer->crowd(), person, 1.0f, seconds);
      if (view.snap_below > 0.0f) pose = atNearestKey(body, pose);
      const std::vector<Mat4> matrices = posedMatrices(body, pose);
      std::array<Vec3, 3> corners;
      const Triangle& face = body.faces[FaceId(picture.face[pixel] - 1)];
      for (std::size_t c = 0; c < 3; ++c) {
        corners[c] = Vec3(pose.world_from_model *
                          Vec4(skinPosition(body.vertices[VertexId(face[c])], matrices), 1.0f));
      }
      const testing::Hit hit = testing::intersect(view, pixel % view.width, pixel / view.width, corners);
      EXPECT_LT(hit.outside, most_outside) << pixel << " at " << seconds;
      if (std::abs(glm::dot(hit.normal, glm::normalize(corners[0] - view.camera.position))) > 0.05f) {
        EXPECT_NEAR(hit.depth, picture.depth[pixel], 2e-3f) << pixel << " at " << seconds;
      }
      const std::uint16_t joint = body.vertices[VertexId(face[0])].skin.joints[0];
      if (legs->groups[joint] != 0) ++leg_pixels;
      if (pose.idle_weight > 0.0f) ++blended;
    }
  }
  EXPECT_GT(leg_pixels, 300u);
  EXPECT_GT(blended, 15u) << "somebody stands or is about to";
}

TEST_F(WalkerGpuTest, AFrameIsTheSameAloneAndInAnyOrder) {
  View view = viewOf(scene_);
  const auto renderer = makeRenderer(scene_);
  const Picture late = draw(*renderer, view, 5.0);
  const Picture early = draw(*renderer, view, 2.0);
  EXPECT_NE(late.color.rgba, early.color.rgba);
  EXPECT_EQ(draw(*renderer, view, 5.0).color.rgba, late.color.rgba);
  EXPECT_EQ(drawScene(scene_, view, 2.0).color.rgba, early.color.rgba);
}

}  // namespace
}  // namespace ensemble
