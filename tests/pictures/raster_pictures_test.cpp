// The two rasterisers' pictures of real people (../shared/people): near, far, from among them and through the
// camera's planes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "assetpipe/pipeline.h"
#include "renderer/renderer.h"
#include "tests/support/picture_difference.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

namespace fs = std::filesystem;

const fs::path kPeople = "../shared/people";  // tests run in the project's folder

struct Shot {
  const char* name;
  const char* camera;
  double seconds;
  std::uint32_t samples;
  float snap_below = 100000.0f;  ///< pixels; 0: everybody is between key frames
};
/// `mixed` and `low`: some people cross the near plane, or fill the picture, and are the pipeline's.
constexpr Shot kShots[] = {
    {"near", "{position: [0, 1.8, 6], target: [0, 0.9, 0], fov_y: 45}", 0.37, 1},
    {"near, 4 samples", "{position: [0, 1.8, 6], target: [0, 0.9, 0], fov_y: 45}", 0.37, 4},
    {"far", "{position: [0, 14, 60], target: [0, 0.9, 0], fov_y: 11}", 0.0, 1},
    {"far, 4 samples", "{position: [0, 14, 60], target: [0, 0.9, 0], fov_y: 11}", 1.1, 4},
    {"mixed", "{position: [0.3, 1.5, 0.4], target: [3, 1.2, 1], fov_y: 70}", 0.9, 1},
    {"low", "{position: [-1.2, 0.1, 1], target: [2, 1, -2], fov_y: 100, near: 0.5}", 2.1, 1},
    {"above", "{position: [0, 9, 0.5], target: [0, 0, 0], fov_y: 50}", 0.2, 1},
    {"near, between keys", "{position: [0, 1.8, 6], target: [0, 0.9, 0], fov_y: 45}", 0.37, 1, 0.0f},
    {"mixed, both", "{position: [0.3, 1.5, 0.4], target: [3, 1.2, 1], fov_y: 70}", 0.9, 1, 150.0f},
    {"far, between keys, 4 samples", "{position: [0, 14, 60], target: [0, 0.9, 0], fov_y: 11}", 1.1, 4,
     0.0f}};

class RasterPictures : public ::testing::Test {
 protected:
  void SetUp() override {
    if (deviceName() == "none") GTEST_SKIP() << "there is no Vulkan device";
    if (!fs::exists(kPeople)) {
      GTEST_SKIP() << "LOUD: ../shared/people is absent, so the rasterisers were not compared on real people";
    }
    for (const char* sex : {"female", "male"}) {
      std::vector<fs::path> outfits;
      for (const auto& entry : fs::directory_iterator(kPeople / sex / "outfits"))
        outfits.push_back(entry.path());
      std::sort(outfits.begin(), outfits.end());
      tagWardrobe(kPeople / sex / "template.glb", outfits, folder_ / sex, {});
      wardrobes_.push_back(loadWardrobe(folder_ / sex));
    }
  }

  Picture render(const Shot& shot, const char* raster, const char* background = "sky") {
    const std::string text = std::string("version: 1\nwardrobe: {female: female, male: male}\nraster: ") +
                             raster + "\nposes: {snap_below: " + std::to_string(shot.snap_below) +
                             "}\noutput: {width: 480, height: 270, samples: " + std::to_string(shot.samples) +
                             ", background: " + background +
                             "}\ncrowd: {count: 90, seed: 5, placement: {kind: disc, spacing: 0.8}, clips: "
                             "{walk: 0.6, idle: 0.4}}\n"
                             "camera: " +
                             shot.camera + "\n";
    const Scene scene = parseScene(text, folder_ / "scene.yaml");
    Renderer renderer;
    renderer.load(scene, wardrobes_);
    View view = viewOf(scene);
    view.aovs = {Aov::kCharacter, Aov::kDepth};
    Picture picture;
    renderer.render(std::span(&view, 1), shot.seconds, std::span(&picture, 1));
    return picture;
  }

  testing::TemporaryFolder folder_;
  std::vector<Wardrobe> wardrobes_;
};

/// Pixels of which people cover something, on a transparent background.
std::size_t countCovered(const Image8& picture) {
  std::size_t count = 0;
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) count += picture.rgba[i] > 0;
  return count;
}

/// Pixels inside of a person, with all their neighbours, at which the other picture shows somebody else, or
/// what lies behind.
std::size_t countHoles(const Picture& from, const Picture& other) {
  const std::uint32_t width = from.color.width, height = from.color.height;
  std::size_t holes = 0;
  for (std::uint32_t y = 1; y + 1 < height; ++y) {
    for (std::uint32_t x = 1; x + 1 < width; ++x) {
      const std::size_t at = std::size_t{y} * width + x;
      const std::uint32_t person = from.character[at];
      bool inside = person != 0;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t near = at + static_cast<std::size_t>(dy * static_cast<int>(width) + dx);
          inside =
              inside && from.character[near] == person && std::abs(from.depth[near] - from.depth[at]) < 0.05f;
        }
      }
      if (!inside) continue;
      holes += other.character[at] != person || std::abs(other.depth[at] - from.depth[at]) > 0.06f;
    }
  }
  return holes;
}

TEST_F(RasterPictures, AreTheSameWithoutHoles) {
  for (const Shot& shot : kShots) {
    const Picture pipeline = render(shot, "pipeline"), compute = render(shot, "compute");
    const std::size_t people = countCovered(render(shot, "pipeline", "transparent").color);
    const std::size_t differing = testing::countDifferences(pipeline.color, compute.color);
    std::printf("%s: %u of %u people in compute, %zu of %zu pixels differ (%.3f %%)\n", shot.name,
                compute.stats.characters_computed, compute.stats.characters_drawn, differing, people,
                100.0 * static_cast<double>(differing) / static_cast<double>(people));
    EXPECT_EQ(pipeline.stats.characters_computed, 0u) << shot.name;
    EXPECT_GT(compute.stats.characters_computed, 5u) << shot.name;
    EXPECT_GT(people, 10000u) << shot.name;
    EXPECT_LE(static_cast<double>(differing), 0.002 * static_cast<double>(people)) << shot.name;
    EXPECT_EQ(countHoles(pipeline, compute), 0u) << shot.name;
    EXPECT_EQ(countHoles(compute, pipeline), 0u) << shot.name;
  }
}

}  // namespace
}  // namespace ensemble
