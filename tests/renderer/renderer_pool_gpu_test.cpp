// Several renderers give the pictures of one, and where there is no memory for several, one draws them all.
#include "renderer/renderer_pool.h"

#include "core/input_error.h"
#include "core/parallel.h"
#include "tests/renderer/gpu_fixture.h"

namespace ensemble {
namespace {

using testing::GpuTest;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(AutomaticRendererCount, IsOneOnAGpuAndOneACoreWhereThereAreFramesEnough) {
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = false, .cores = 16, .frames = 1000}), 1u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 2, .frames = 1000}), 2u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 16, .frames = 1000}), 8u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 16, .frames = 12}), 3u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 16, .frames = 99, .is_computed = true}), 4u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 2, .frames = 99, .is_computed = true}), 1u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 16, .frames = 1}), 1u);
  EXPECT_EQ(automaticRendererCount({.is_on_cpu = true, .cores = 16, .frames = 0}), 1u);
}

class RendererPoolTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    scene_ = testing::tubeScene(30);
    scene_.output.samples = 1;
    view_ = viewOf(scene_);
    view_.width = 160;
    view_.height = 120;
    view_.aovs = testing::allAovs();
  }

  std::unique_ptr<RendererPool> makePool(unsigned count, std::uint64_t memory_limit = 0) {
    auto pool = std::make_unique<RendererPool>(
        RendererOptions{.validate = testing::hasValidationLayer(), .memory_limit = memory_limit},
        PoolScene{.scene = &scene_, .wardrobes = wardrobes_});
    pool->allow(count);
    return pool;
  }

  /// A sequence, drawn by `threads` threads.
  std::vector<Picture> drawAll(RendererPool& pool, unsigned threads) {
    std::vector<Picture> pictures(kFrames);
    forEachOnThreads(threads, kFrames, [&](std::size_t i, unsigned) {
      pool.draw(view_, static_cast<double>(i) / 10.0, pictures[i]);
    });
    EXPECT_THAT(pool.validationMessages(), IsEmpty());
    return pictures;
  }

  static void expectSame(const std::vector<Picture>& pictures, const std::vector<Picture>& truth) {
    for (std::size_t i = 0; i < kFrames; ++i) {
      EXPECT_EQ(pictures[i].color.rgba, truth[i].color.rgba) << i;
      EXPECT_EQ(pictures[i].character, truth[i].character) << i;
      EXPECT_EQ(pictures[i].face, truth[i].face) << i;
      EXPECT_EQ(pictures[i].depth, truth[i].depth) << i;
      EXPECT_EQ(pictures[i].stats.triangles(), truth[i].stats.triangles()) << i;
    }
  }

  static constexpr std::size_t kFrames = 9;
  Scene scene_;
  View view_;
};

TEST_F(RendererPoolTest, DrawsTheSameWithAnyNumberAndByBothRasterisers) {
  for (const RasterKind raster : {RasterKind::kPipeline, RasterKind::kCompute}) {
    scene_.raster = view_.raster = raster;
    const auto one = makePool(1);
    const std::vector<Picture> truth = drawAll(*one, 1);
    EXPECT_NE(truth[0].color.rgba, truth[1].color.rgba) << "they move";
    EXPECT_EQ(one->madeCount(), 1u);
    for (const unsigned count : {1u, 2u, 3u}) {
      const auto pool = makePool(count);
      expectSame(drawAll(*pool, count + 1), truth);
      EXPECT_EQ(pool->madeCount(), count);
    }
  }
}

TEST_F(RendererPoolTest, OneDrawsTheRestWhereThereIsNoMemoryForMore) {
  // How much one takes when it is loaded, and when it has drawn.
  const auto probe = makeRenderer(scene_);
  const std::uint64_t loaded = probe->memoryInUse();
  const auto one = makePool(1);
  const std::vector<Picture> truth = drawAll(*one, 1);
  draw(*probe, view_);
  const std::uint64_t drawn = probe->memoryInUse();
  ASSERT_GT(drawn, loaded + (1u << 20));

  // No second one can be made.
  ::testing::internal::CaptureStderr();
  const auto short_of_all = makePool(2, drawn + loaded / 2);
  expectSame(drawAll(*short_of_all, 3), truth);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("ensemble: warning: no more renderers can be made, frames are drawn by 1: "));
  EXPECT_EQ(short_of_all->madeCount(), 1u);

  // A second one can be loaded, but not draw: it goes, and its frame is drawn by the first, or the other way.
  ::testing::internal::CaptureStderr();
  const auto short_of_targets = makePool(2, drawn + loaded + (drawn - loaded) / 2);
  expectSame(drawAll(*short_of_targets, 3), truth);
  EXPECT_THAT(
      ::testing::internal::GetCapturedStderr(),
      HasSubstr("ensemble: warning: one renderer alone draws the rest of the frames: Vulkan device "));
  EXPECT_EQ(short_of_targets->madeCount(), 2u);

  // Where the number was chosen by the program, it is chosen by what there is, and nothing is said.
  ::testing::internal::CaptureStderr();
  const auto fitted = makePool(1, 3 * drawn);
  fitted->allowAutomatic(100, 16);
  expectSame(drawAll(*fitted, 4), truth);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(fitted->madeCount(), 2u);
}

TEST_F(RendererPoolTest, AnErrorIsThatOfOneAlone) {
  const auto probe = makeRenderer(scene_);
  draw(*probe, view_);
  const std::uint64_t limit = 3 * probe->memoryInUse();
  View large = view_;
  large.width = large.height = 4000;
  large.samples = 4;
  const auto error_of = [&](RendererPool& pool) -> std::string {
    Picture picture;
    try {
      pool.draw(large, 0.0, picture);
    } catch (const SystemError& error) {
      return error.what();
    }
    return "no error";
  };
  const auto one = makePool(1, limit), two = makePool(2, limit);
  drawAll(*one, 1);
  drawAll(*two, 3);
  EXPECT_EQ(two->madeCount(), 2u);
  ::testing::internal::CaptureStderr();
  const std::string error = error_of(*two);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "") << "no warning beside the error";
  EXPECT_THAT(error, HasSubstr("does not fit"));
  EXPECT_EQ(error, error_of(*one));
}

}  // namespace
}  // namespace ensemble
