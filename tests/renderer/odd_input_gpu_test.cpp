// What neither rasteriser must stumble over: meshes, clips, people and cameras at the edge of what files may
// hold.
#include "tests/renderer/gpu_fixture.h"
#include "tests/support/picture_difference.h"

namespace ensemble {
namespace {

using testing::countDifferences;
using testing::GpuTest;

class OddInput : public GpuTest {
 protected:
  static Scene crowd() {
    Scene scene = testing::tubeScene(40);
    scene.output.width = 320;
    scene.output.height = 180;
    scene.camera.position = Vec3(0.4f, 3.0f, 7.0f);
    return scene;
  }

  /// Draws by both, at key frames and between them, and holds the pictures against each other.
  /// @returns people whom compute drew, in all
  std::size_t compareRasterisers(Scene scene, double seconds = 0.37) {
    std::size_t computed = 0;
    for (const float snap_below : {0.0f, 1e5f}) {
      scene.poses.snap_below = snap_below;
      std::array<Picture, 2> pictures;
      for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
        scene.raster = raster;
        View view = viewOf(scene);
        view.aovs = testing::allAovs();
        pictures[raster == RasterKind::kCompute] = drawScene(scene, view, seconds);
      }
      const auto& [pipeline, compute] = pictures;
      computed += compute.stats.characters_computed;
      people_pixels_ = testing::countPeoplePixels(pipeline);
      EXPECT_LE(countDifferences(pipeline.color, compute.color), people_pixels_ / 200 + 5) << snap_below;
      for (const float depth : compute.depth) EXPECT_TRUE(depth >= 0.0f) << "no NaN";
    }
    return computed;
  }

  std::size_t people_pixels_ = 0;
};

TEST_F(OddInput, TrianglesWithoutAreaAndMeshesOfOneTriangle) {
  for (Item& item : wardrobes_[0].items) {
    ASSERT_FALSE(item.garments.empty());
    RawPrimitive& part = item.garments[0].parts[0];
    const Triangle face = part.faces[0];
    part.faces.push_back({face[0], face[0], face[1]});
    part.faces.push_back({face[2], face[2], face[2]});
    // Three corners in one place, and in one line.
    for (const float along : {0.0f, 1.0f}) {
      const auto first = static_cast<std::uint32_t>(part.vertices.size());
      for (int i = 0; i < 3; ++i) {
        RawVertex vertex = part.vertices[face[0]];
        vertex.position += Vec3(0.0f, 0.1f * along * static_cast<float>(i), 0.0f);
        part.vertices.push_back(vertex);
      }
      part.faces.push_back({first, first + 1, first + 2});
    }
  }
  RawPrimitive& hat = wardrobes_[0].items[ItemId(2)].garments.back().parts[0];
  hat.faces.resize(1);
  EXPECT_GT(compareRasterisers(crowd()), 60u);
  EXPECT_GT(people_pixels_, 2000u);
}

TEST_F(OddInput, ClipsOfOneKey) {
  for (Clip& clip : wardrobes_[0].body.clips) {
    clip.transforms.resize(clip.transforms.size() / clip.key_count);
    clip.key_count = 1;
    clip.seconds = 0.0f;
  }
  EXPECT_GT(compareRasterisers(crowd()), 60u);
  EXPECT_GT(people_pixels_, 2000u);
}

TEST_F(OddInput, PeopleOfHardlyAnySizeAndGiants) {
  Scene scene = crowd();
  scene.crowd.scale = {0.01f, 0.01f};
  EXPECT_GT(compareRasterisers(scene), 60u);
  EXPECT_LT(people_pixels_, 200u);
  scene.crowd.scale = {100.0f, 100.0f};
  scene.camera = {.position = Vec3(50.0f, 300.0f, 900.0f), .target = Vec3(0.0f, 90.0f, 0.0f)};
  compareRasterisers(scene);
  EXPECT_GT(people_pixels_, 0u);
}

TEST_F(OddInput, CamerasInsideOfPeopleAndOfAnyAngle) {
  Scene scene = crowd();
  scene.people.push_back({});
  scene.people.back().position = Vec3(0.0f, 0.0f, 0.0f);
  scene.camera = {.position = Vec3(0.0f, 0.9f, 0.0f), .target = Vec3(3.0f, 0.9f, 1.0f), .near_plane = 0.01f};
  compareRasterisers(scene);
  scene.camera = {
      .position = Vec3(0.4f, 3.0f, 7.0f), .target = Vec3(0.0f, 0.9f, 0.0f), .fov_y = radians(0.01f)};
  compareRasterisers(scene);
  scene.camera.fov_y = radians(179.0f);
  compareRasterisers(scene);
  scene.camera = {.position = Vec3(0.0f, 40.0f, 0.0f), .target = Vec3(0.0f)};  // straight down
  EXPECT_GT(compareRasterisers(scene), 60u);
}

}  // namespace
}  // namespace ensemble
