// How long the CPU takes for the render queues of a frame: 12 sub-meshes a character, 64
// combinations, three of four characters visible or all. Goal: 0.3 ms per 1,000, linear to 100,000.
#include <benchmark/benchmark.h>

#include <vector>

#include "core/random.h"
#include "renderer/queues.h"

namespace ensemble {
namespace {

constexpr std::size_t kSubMeshCount = 256, kCombinationCount = 64, kShownCount = 12;

std::vector<std::vector<SubMeshId>> makeShown() {
  const RandomStream random(1, 0);
  std::vector<std::vector<SubMeshId>> shown(kCombinationCount);
  std::uint64_t draw = 0;
  for (auto& sub_meshes : shown) {
    // Choose 12 of 256, ascending, each set alike.
    for (std::size_t s = 0; s < kSubMeshCount; ++s) {
      const double chance =
          static_cast<double>(kShownCount - sub_meshes.size()) / static_cast<double>(kSubMeshCount - s);
      if (random.uniform(draw++) < chance) sub_meshes.emplace_back(s);
    }
  }
  return shown;
}

void BM_RenderQueues(benchmark::State& state) {
  const auto count = static_cast<std::uint32_t>(state.range(0));
  const auto visible_of_four = static_cast<std::uint64_t>(state.range(1));
  const RandomStream random(2, 0);
  std::vector<std::uint32_t> combinations(count), visible;
  for (std::uint32_t i = 0; i < count; ++i) {
    combinations[i] = random.bits32(i) % kCombinationCount;
    if (random.bits(i) % 4 < visible_of_four) visible.push_back(i);
  }
  RenderQueues queues;
  queues.setShown(makeShown(), kSubMeshCount);
  for (auto _ : state) {
    benchmark::DoNotOptimize(queues.build(combinations, visible).data());
    benchmark::ClobberMemory();
  }
  if (queues.entryCount() != visible.size() * kShownCount) state.SkipWithError("wrong number of entries");
  state.counters["per_1000_people"] =
      benchmark::Counter(static_cast<double>(visible.size()) * 1e-3,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(BM_RenderQueues)
    ->ArgNames({"characters", "visible_of_four"})
    ->ArgsProduct({{1000, 10'000, 100'000}, {3, 4}})
    ->Unit(benchmark::kMicrosecond)
    ->Repetitions(15)
    ->ReportAggregatesOnly();

}  // namespace
}  // namespace ensemble

BENCHMARK_MAIN();
