// Boxes, shares and joints against pictures of each person alone.
#include "renderer/ground_truth.h"

#include <algorithm>

#include "renderer/view_setup.h"
#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;

class GroundTruthTest : public GpuTest {
 protected:
  /// A dense group of named people in all outfits, one of them half out of the picture.
  static Scene groupScene() {
    Scene scene = testing::tubeScene(0);
    const char* outfits[] = {"tunic", "net", "patch"};
    for (int i = 0; i < 9; ++i) {
      ScenePerson person;
      person.outfit = {outfits[i % 3], {}};
      person.position = Vec3(0.5f * static_cast<float>(i % 3) - 0.6f, 0.0f, 0.7f * static_cast<float>(i / 3));
      person.heading = 0.4f * static_cast<float>(i);
      person.phase = 0.1f * static_cast<float>(i);
      person.scale = 1.0f + 0.02f * static_cast<float>(i);
      scene.people.push_back(person);
    }
    scene.people.back().position = Vec3(1.7f, 0.0f, 1.0f);
    return scene;
  }
  static View truthView(const Scene& scene) {
    View view = viewOf(scene);
    view.aovs = testing::allAovs();
    view.coverage = true;
    view.ground = false;
    return view;
  }
  static constexpr double kSeconds = 0.37;
};

TEST_F(GroundTruthTest, CoverageIsWhatEachPersonCoversAlone) {
  const Scene scene = groupScene();
  for (const std::uint32_t samples : {1u, 4u}) {
    View view = truthView(scene);
    view.samples = samples;
    const Picture together = drawScene(scene, view, kSeconds);
    ASSERT_EQ(together.coverage.size(), scene.people.size());
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < scene.people.size(); ++i) {
      Scene alone = scene;
      alone.people = {scene.people[i]};
      const std::size_t pixels = testing::countPeoplePixels(drawScene(alone, view, kSeconds));
      EXPECT_EQ(together.coverage[i], pixels) << "person " << i;
      const auto shown = static_cast<std::size_t>(std::count(
          together.character.begin(), together.character.end(), static_cast<std::uint32_t>(i + 1)));
      EXPECT_LE(shown, pixels);
      hidden += pixels - shown;
    }
    EXPECT_GT(hidden, 500u) << "people stand before each other";
  }
}

TEST_F(GroundTruthTest, CoverageIsTheSameInTilesAndWithPeopleInSeveralBuffers) {
  Scene scene = testing::tubeScene(60);
  scene.camera.position = Vec3(0.4f, 4.0f, 9.0f);
  const View view = truthView(scene);
  const Picture whole = drawScene(scene, view);
  const Picture chunks = drawScene(scene, view, 0.0, {.max_buffer_bytes = 6000});
  EXPECT_EQ(whole.coverage, chunks.coverage);
  const Picture tiles = drawScene(scene, view, 0.0, {.tiles = {.side = 64, .pixels = 64 * 64}});
  ASSERT_EQ(tiles.coverage.size(), whole.coverage.size());
  for (std::size_t i = 0; i < whole.coverage.size(); ++i) {
    // An edge may fall to the other side of a pixel's centre where a tile begins (TilesTest).
    EXPECT_NEAR(whole.coverage[i], tiles.coverage[i], 2.0) << i;
  }
}

TEST_F(GroundTruthTest, CoverageIsEmptyUnlessAskedFor) {
  const Scene scene = groupScene();
  View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  Picture picture = draw(*renderer, view);
  EXPECT_FALSE(picture.coverage.empty());
  view.coverage = false;
  renderer->render(std::span(&view, 1), 0.0, std::span(&picture, 1));
  EXPECT_TRUE(picture.coverage.empty());
}

TEST_F(GroundTruthTest, BoxesAndSharesAgreeWithTheAovs) {
  const Scene scene = groupScene();
  const View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view, kSeconds);
  const std::vector<PersonTruth> truths = truthOf(renderer->crowd(), wardrobes_, view, picture, kSeconds);
  ASSERT_GE(truths.size(), 6u);
  for (const PersonTruth& truth : truths) {
    double left = 1e9, right = -1, top = 1e9, bottom = -1, count = 0;
    for (std::uint32_t y = 0; y < view.height; ++y) {
      for (std::uint32_t x = 0; x < view.width; ++x) {
        if (picture.character[std::size_t{y} * view.width + x] != truth.number + 1) continue;
        left = std::min(left, double{static_cast<double>(x)});
        right = std::max(right, x + 1.0);
        top = std::min(top, double{static_cast<double>(y)});
        bottom = std::max(bottom, y + 1.0);
        ++count;
      }
    }
    EXPECT_EQ(truth.box.x, left);
    EXPECT_EQ(truth.box.y, top);
    EXPECT_EQ(truth.box.width, right - left);
    EXPECT_EQ(truth.box.height, bottom - top);
    EXPECT_EQ(truth.visible_pixels, count);
    EXPECT_EQ(truth.pixels_alone, picture.coverage[truth.number]);
    ASSERT_TRUE(truth.whole_box.has_value());
    const PixelBox& whole = *truth.whole_box;
    EXPECT_LE(whole.x, truth.box.x + 1.0);
    EXPECT_LE(whole.y, truth.box.y + 1.0);
    EXPECT_GE(whole.x + whole.width, truth.box.x + truth.box.width - 1.0);
    EXPECT_GE(whole.y + whole.height, truth.box.y + truth.box.height - 1.0);
  }
}

TEST_F(GroundTruthTest, TheWholeBoxIsTightForWhoStandsAlone) {
  Scene scene = groupScene();
  scene.people = {scene.people[2]};  // patch: it has a hat that no joint moves
  const View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  const PersonTruth truth =
      truthOf(renderer->crowd(), wardrobes_, view, draw(*renderer, view, kSeconds), kSeconds).at(0);
  EXPECT_EQ(truth.visible_pixels, truth.pixels_alone);
  EXPECT_NEAR(truth.whole_box->x, truth.box.x, 1.0);
  EXPECT_NEAR(truth.whole_box->y, truth.box.y, 1.0);
  EXPECT_NEAR(truth.whole_box->width, truth.box.width, 2.0);
  EXPECT_NEAR(truth.whole_box->height, truth.box.height, 2.0);
}

TEST_F(GroundTruthTest, NobodyBehindTheCameraHasABox) {
  Scene scene = groupScene();
  scene.people.resize(1);
  scene.people[0].position = scene.camera.position - Vec3(0.0f, 1.0f, 0.1f);  // around the camera
  const View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view, kSeconds);
  const auto truths = truthOf(renderer->crowd(), wardrobes_, view, picture, kSeconds);
  EXPECT_EQ(truths.size(), 1u);
  for (const PersonTruth& truth : truths) EXPECT_FALSE(truth.whole_box.has_value());
  const PinholeCamera camera = pinholeOf(view);
  EXPECT_FALSE(camera.project(scene.camera.position).has_value());
  EXPECT_FALSE(
      camera.project(scene.camera.position - (scene.camera.target - scene.camera.position)).has_value());
}

// Every pixel's point in the world, by the depth AOV, lies in its person's box and falls on the pixel.
TEST_F(GroundTruthTest, TheCameraAndTheBoxInSpaceHoldWhatShows) {
  const Scene scene = groupScene();
  const View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view, kSeconds);
  const PinholeCamera camera = pinholeOf(view);
  const CameraFrame frame = cameraFrame(view.camera);
  const double focal = camera.intrinsics[0][0];
  for (const PersonTruth& truth : truthOf(renderer->crowd(), wardrobes_, view, picture, kSeconds)) {
    const Mat3 to_box =
        glm::transpose(Mat3(std::cos(truth.heading), 0.0f, -std::sin(truth.heading), 0.0f, 1.0f, 0.0f,
                            std::sin(truth.heading), 0.0f, std::cos(truth.heading)));
    for (std::size_t i = 0; i < picture.character.size(); ++i) {
      if (picture.character[i] != truth.number + 1) continue;
      const double x = static_cast<double>(i % view.width) + 0.5,
                   y = static_cast<double>(i / view.width) + 0.5;
      const float depth = picture.depth[i];
      const Vec3 world =
          view.camera.position +
          depth * (frame.forward + frame.right * static_cast<float>((x - 0.5 * view.width) / focal) -
                   frame.up * static_cast<float>((y - 0.5 * view.height) / focal));
      const std::optional<glm::dvec2> place = camera.project(world);
      ASSERT_TRUE(place.has_value());
      EXPECT_NEAR(place->x, x, 1e-3);
      EXPECT_NEAR(place->y, y, 1e-3);
      const Vec3 local = glm::abs(to_box * (world - truth.center));
      for (int axis = 0; axis < 3; ++axis) EXPECT_LE(local[axis], 0.5f * truth.size[axis] + 2e-3f) << axis;
    }
  }
}

TEST_F(GroundTruthTest, AJointShowsWhereItsPixelShowsItsPerson) {
  const Scene scene = groupScene();
  const View view = truthView(scene);
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view, kSeconds);
  std::size_t showing = 0, hidden = 0;
  for (const PersonTruth& truth : truthOf(renderer->crowd(), wardrobes_, view, picture, kSeconds)) {
    ASSERT_EQ(truth.joints.size(), wardrobes_[0].body.skeleton.joints.size());
    ASSERT_EQ(truth.picture_joints.size(), truth.joints.size());
    for (std::size_t j = 0; j < truth.joints.size(); ++j) {
      const PictureJoint& joint = truth.picture_joints[j];
      ASSERT_TRUE(joint.place.has_value());
      const bool inside = joint.place->x >= 0 && joint.place->x < view.width && joint.place->y >= 0 &&
                          joint.place->y < view.height;
      const auto pixel = static_cast<std::size_t>(std::floor(joint.place->y)) * view.width +
                         static_cast<std::size_t>(std::floor(joint.place->x));
      EXPECT_EQ(joint.shows, inside && picture.character[pixel] == truth.number + 1);
      ++(joint.shows ? showing : hidden);
    }
  }
  EXPECT_GT(showing, 5u);
  EXPECT_GT(hidden, 3u);
}

}  // namespace
}  // namespace ensemble
