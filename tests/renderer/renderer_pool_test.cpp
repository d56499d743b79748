// The pool's own work, with renderers that only count: who is made, who goes, what is said. (With real ones:
// renderer_pool_gpu_test.cpp.)
#include "renderer/renderer_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>

#include "core/input_error.h"
#include "core/parallel.h"

namespace ensemble {
namespace {

/// Of a renderer, in bytes.
constexpr std::uint64_t kLoaded = 100, kDrawing = 50;

std::atomic<int> g_made{0}, g_alive{0};
std::uint32_t g_computed = 0;  // of 3 people
std::function<void(int number, double seconds)> g_on_render;

[[noreturn]] void refuse(const std::string& what) { throw SystemError({"", "device", what, "use less"}); }

}  // namespace

/// Stands in for the real one, of which nothing is linked.
struct Renderer::Impl {
  explicit Impl(RendererOptions given) : options(std::move(given)) { ++g_alive; }
  ~Impl() {
    options.memory->giveBack(taken);
    --g_alive;
  }
  void take(std::uint64_t bytes) {
    if (!options.memory->take(bytes, options.memory_limit)) refuse("it does not fit");
    taken += bytes;
  }

  RendererOptions options;
  int number = g_made++;
  std::uint64_t taken = 0;
  Crowd crowd;
  AovNumbers numbers;
  std::atomic<bool> is_busy{false};
};

Renderer::Renderer(const RendererOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

void Renderer::load(const Scene&, std::span<const Wardrobe>, const EnvironmentMesh*) {
  impl_->take(kLoaded);
  impl_->crowd.characters.resize(3);
}

void Renderer::load(const Scene&, std::span<const Wardrobe>, const EnvironmentMesh*, Crowd crowd) {
  impl_->take(kLoaded);
  impl_->crowd = std::move(crowd);
}

void Renderer::render(std::span<const View>, double seconds, std::span<Picture> pictures) {
  EXPECT_FALSE(impl_->is_busy.exchange(true)) << "two frames at once";
  struct Idle {
    std::atomic<bool>& is_busy;
    ~Idle() { is_busy = false; }
  } const idle{impl_->is_busy};
  EXPECT_EQ(impl_->crowd.characters.size(), 3u) << "the first one's crowd";
  if (impl_->taken == kLoaded) impl_->take(kDrawing);
  if (g_on_render) g_on_render(impl_->number, seconds);
  pictures[0].stats.frame_ms = seconds;
  pictures[0].stats.characters_drawn = 3;
  pictures[0].stats.characters_computed = g_computed;
}

const Crowd& Renderer::crowd() const { return impl_->crowd; }
const AovNumbers& Renderer::aovNumbers() const { return impl_->numbers; }
std::string Renderer::deviceName() const { return "counter"; }
bool Renderer::isOnCpu() const { return true; }
std::uint64_t Renderer::memoryInUse() const { return impl_->options.memory->used(); }
std::uint64_t Renderer::memoryLimit() const { return impl_->options.memory_limit; }
std::vector<std::string> Renderer::validationMessages() const { return {std::to_string(impl_->number)}; }

namespace {

using ::testing::ElementsAre;

class PoolOfCounters : public ::testing::Test {
 protected:
  void SetUp() override {
    g_made = 0;
    g_computed = 0;
    g_on_render = nullptr;
  }
  void TearDown() override { EXPECT_EQ(g_alive, 0); }

  RendererPool makePool(std::uint64_t memory = 1'000'000) {
    return RendererPool({.memory_limit = memory}, {.scene = &scene_, .wardrobes = {}});
  }

  /// What standard error got while frames 0 .. count - 1 were drawn.
  std::string drawAll(RendererPool& pool, unsigned threads, std::size_t count = 200) {
    ::testing::internal::CaptureStderr();
    forEachOnThreads(threads, count, [&](std::size_t i, unsigned) {
      Picture picture;
      pool.draw({}, static_cast<double>(i), picture);
      EXPECT_EQ(picture.stats.frame_ms, static_cast<double>(i));
    });
    return ::testing::internal::GetCapturedStderr();
  }

  Scene scene_;
};

TEST_F(PoolOfCounters, MakesAsManyAsAreAllowed) {
  for (const unsigned threads : {1u, 2u, 6u}) {
    for (const unsigned allowed : {1u, 2u, 5u}) {
      g_made = 0;
      RendererPool pool = makePool();
      pool.allow(allowed);
      EXPECT_EQ(g_alive, 1);
      EXPECT_EQ(drawAll(pool, threads), "");
      EXPECT_EQ(pool.madeCount(), allowed);
      EXPECT_EQ(g_alive, static_cast<int>(allowed));
      EXPECT_EQ(pool.validationMessages().size(), allowed);
      EXPECT_EQ(pool.validationMessages()[0], "0");
    }
  }
}

TEST_F(PoolOfCounters, MakesFewerWhereComputeShadersDraw) {
  const std::size_t made[] = {8, 8, 4, 4};
  for (std::uint32_t computed = 0; computed < 4; ++computed) {
    g_computed = computed;
    RendererPool pool = makePool();
    EXPECT_EQ(pool.allowAutomatic(200, 16), 8u);
    EXPECT_EQ(drawAll(pool, 3), "");
    EXPECT_EQ(pool.madeCount(), made[computed]) << computed << " of 3 people";
  }
}

TEST_F(PoolOfCounters, StopsAtWhatTheMemoryHolds) {
  const std::string line =
      "ensemble: warning: no more renderers can be made, frames are drawn by 2: device: it does not fit; use "
      "less\n";
  RendererPool asked = makePool(2 * (kLoaded + kDrawing) + kDrawing - 1);
  asked.allow(3);
  EXPECT_EQ(drawAll(asked, 1), line);
  EXPECT_EQ(asked.madeCount(), 2u);
  RendererPool fitted = makePool(3 * (kLoaded + kDrawing));
  EXPECT_EQ(fitted.allowAutomatic(200, 16), 8u);
  EXPECT_EQ(drawAll(fitted, 4), "");
  EXPECT_EQ(fitted.madeCount(), 2u);
}

TEST_F(PoolOfCounters, OneGoesOnAloneWhereAnotherFails) {
  const std::string line =
      "ensemble: warning: one renderer alone draws the rest of the frames: device: it does not fit; use "
      "less\n";
  for (const unsigned threads : {1u, 2u, 6u}) {
    RendererPool pool = makePool(2 * kLoaded + kDrawing + 1);  // a second one can be loaded, but not draw
    pool.allow(2);
    EXPECT_EQ(drawAll(pool, threads), line) << threads;
    EXPECT_EQ(pool.madeCount(), 2u);
    EXPECT_EQ(g_alive, 1);
    EXPECT_EQ(pool.validationMessages().size(), 2u) << "of the one that went, too";
  }
  // Whichever fails, in the middle, and several at a time: each frame is drawn all the same.
  for (const unsigned threads : {1u, 2u, 6u}) {
    RendererPool pool = makePool();
    pool.allow(5);
    g_on_render = [](int, double seconds) {
      if (seconds > 50.0 && g_alive > 1) refuse("it does not fit");
    };
    EXPECT_EQ(drawAll(pool, threads), line) << threads;
    EXPECT_EQ(g_alive, 1);
    g_on_render = nullptr;
  }
}

TEST_F(PoolOfCounters, ThrowsOnlyWhatOneAloneThrows) {
  for (const unsigned threads : {1u, 2u, 6u}) {
    for (const unsigned allowed : {1u, 3u}) {
      RendererPool pool = makePool();
      pool.allow(allowed);
      g_on_render = [](int, double seconds) {
        if (seconds == 70.0) refuse("it is the 70th");
      };
      std::string error;
      ::testing::internal::CaptureStderr();
      try {
        forEachOnThreads(threads, 200, [&](std::size_t i, unsigned) {
          Picture picture;
          pool.draw({}, static_cast<double>(i), picture);
        });
      } catch (const SystemError& thrown) {
        error = thrown.what();
      }
      EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
      EXPECT_EQ(error, "device: it is the 70th; use less");
      EXPECT_EQ(g_alive, 1) << "the others gave their memory for a second try";
      g_on_render = nullptr;
    }
  }
}

}  // namespace
}  // namespace ensemble
