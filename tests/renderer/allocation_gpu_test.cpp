// A frame allocates nothing on the calling thread once it has been drawn (house style 13).
#include <cstdlib>
#include <new>

#include "tests/renderer/gpu_fixture.h"
#include "tests/support/small_sets.h"

namespace {

thread_local bool is_counting = false;
thread_local std::size_t allocation_count = 0;

void* countedAllocation(std::size_t bytes, std::size_t alignment) {
  if (is_counting) ++allocation_count;
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  void* memory =
      alignment > alignof(std::max_align_t) ? std::aligned_alloc(alignment, rounded) : std::malloc(rounded);
  if (!memory) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) { return countedAllocation(bytes, alignof(std::max_align_t)); }
void* operator new[](std::size_t bytes) { return countedAllocation(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return countedAllocation(bytes, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t bytes, std::align_val_t alignment) {
  return countedAllocation(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace ensemble {
namespace {

TEST(Allocation, TheCounterCounts) {
  allocation_count = 0;
  is_counting = true;
  const auto value = std::make_unique<std::vector<int>>(10);
  is_counting = false;
  EXPECT_EQ(allocation_count, 2u);
  EXPECT_EQ(value->size(), 10u);
}

// Without the validation layer, which runs on this thread too and allocates as it likes.
TEST(Allocation, AFrameAllocatesNothing) {
  if (deviceName() == "none") GTEST_SKIP() << "there is no Vulkan device";
  Scene scene = testing::tubeScene(100);  // enough for two rounds of occlusion culling
  scene.occlusion = true;
  const std::vector<Wardrobe> wardrobes = {testing::tubeWardrobe()};
  const EnvironmentMesh set = buildEnvironmentMesh(
      testing::setOf({testing::floorAt(0.0f, 10.0f), testing::wallAt(-2.0f, -3.0f, 3.0f, 3.0f)}), "set.glb");
  for (const Technique technique : kAllTechniques) {
    scene.technique = technique;
    Renderer renderer;
    renderer.load(scene, wardrobes, &set);
    std::vector<View> views(2, viewOf(scene));
    views[0].samples = 4;
    views[1].aovs = testing::allAovs();
    views[1].background = BackgroundKind::kTransparent;
    std::vector<Picture> pictures(views.size());
    renderer.render(views, 0.0, pictures);
    const auto draw_all = [&] {
      for (int frame = 1; frame < 6; ++frame) {
        // A camera that moves: other people come into sight, other shadows fall.
        for (View& view : views) view.camera.position.x = 0.8f * static_cast<float>(frame);
        renderer.render(views, frame / 30.0, pictures);
      }
    };
    draw_all();  // poses that are needed for the first time are noted down
    EXPECT_GT(pictures[0].stats.characters_computed, 0u);
    allocation_count = 0;
    is_counting = true;
    draw_all();
    is_counting = false;
    EXPECT_EQ(allocation_count, 0u) << toString(technique);
  }
}

TEST(Allocation, AFrameCulledOnTheDeviceAllocatesNothing) {
  if (deviceName() == "none") GTEST_SKIP() << "there is no Vulkan device";
  Scene scene = testing::tubeScene(50);
  scene.raster = RasterKind::kPipeline;
  scene.culling = CullingKind::kDevice;
  const std::vector<Wardrobe> wardrobes = {testing::tubeWardrobe()};
  Renderer renderer;
  renderer.load(scene, wardrobes);
  std::vector<View> views(2, viewOf(scene));
  views[0].samples = 4;
  views[1].aovs = testing::allAovs();
  std::vector<Picture> pictures(views.size());
  renderer.render(views, 0.0, pictures);
  EXPECT_TRUE(pictures[1].stats.culled_on_device);
  allocation_count = 0;
  is_counting = true;
  for (int frame = 1; frame < 6; ++frame) {
    for (View& view : views) view.camera.position.x = 0.8f * static_cast<float>(frame);
    renderer.render(views, frame / 30.0, pictures);
  }
  is_counting = false;
  EXPECT_EQ(allocation_count, 0u);
}

}  // namespace
}  // namespace ensemble
