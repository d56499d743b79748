#include "renderer/queues.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <numeric>

#include "core/check.h"
#include "core/random.h"

// Every allocation of this test program is counted. malloc is what the sanitizers watch, too.
namespace {
std::atomic<std::size_t> allocation_count{0};

void* allocate(std::size_t bytes) {
  ++allocation_count;
  if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes); }
void* operator new[](std::size_t bytes) { return allocate(bytes); }
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  ++allocation_count;
  return std::malloc(bytes == 0 ? 1 : bytes);
}
void* operator new[](std::size_t bytes, const std::nothrow_t& tag) noexcept {
  return operator new(bytes, tag);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace ensemble {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

using Shown = std::vector<std::vector<SubMeshId>>;

std::vector<SubMeshId> ids(std::initializer_list<std::size_t> numbers) {
  std::vector<SubMeshId> result;
  for (const std::size_t number : numbers) result.emplace_back(number);
  return result;
}

std::vector<std::uint32_t> queue(const RenderQueues& queues, std::span<const std::uint32_t> entries,
                                 std::size_t sub_mesh) {
  const auto part = entries.subspan(queues.offsets()[sub_mesh], queues.lengths()[sub_mesh]);
  return {part.begin(), part.end()};
}

std::vector<std::uint32_t> iota(std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0u);
  return numbers;
}

// Lister, Laycock and Day, table 1: character 0 wears a dress, character 1 a jumper and a skirt.
TEST(RenderQueues, GiveThePapersTable1) {
  enum : std::size_t {
    kHead,
    kHands,
    kFeet,
    kArms,
    kArmsJumper,
    kTorso,
    kTorsoDress,
    kTorsoSkirt,
    kLegs,
    kLegsDress,
    kLegsSkirt,
    kDress,
    kJumper,
    kSkirt,
    kCount
  };
  const Shown shown{ids({kHead, kHands, kFeet, kArms, kTorsoDress, kLegsDress, kDress}),
                    ids({kHead, kHands, kFeet, kArmsJumper, kTorsoSkirt, kLegsSkirt, kJumper, kSkirt})};
  RenderQueues queues;
  queues.setShown(shown, kCount);
  const std::vector<std::uint32_t> combinations{0, 1};
  const auto entries = queues.build(combinations, iota(2));
  for (const std::size_t sub_mesh : {kHead, kHands, kFeet}) {
    EXPECT_THAT(queue(queues, entries, sub_mesh), ElementsAre(0, 1));
  }
  EXPECT_THAT(queue(queues, entries, kArms), ElementsAre(0));
  EXPECT_THAT(queue(queues, entries, kArmsJumper), ElementsAre(1));
  EXPECT_THAT(queue(queues, entries, kTorso), IsEmpty());
  EXPECT_THAT(queue(queues, entries, kTorsoDress), ElementsAre(0));
  EXPECT_THAT(queue(queues, entries, kTorsoSkirt), ElementsAre(1));
  EXPECT_THAT(queue(queues, entries, kLegs), IsEmpty());
  EXPECT_THAT(queue(queues, entries, kLegsDress), ElementsAre(0));
  EXPECT_THAT(queue(queues, entries, kLegsSkirt), ElementsAre(1));
  EXPECT_THAT(queue(queues, entries, kDress), ElementsAre(0));
  EXPECT_THAT(queue(queues, entries, kJumper), ElementsAre(1));
  EXPECT_THAT(queue(queues, entries, kSkirt), ElementsAre(1));
  EXPECT_THAT(queues.lengths(), ElementsAre(2, 2, 2, 1, 1, 0, 1, 1, 0, 1, 1, 1, 1, 1));
  EXPECT_THAT(queues.offsets(), ElementsAre(0, 2, 4, 6, 7, 8, 8, 9, 10, 10, 11, 12, 13, 14));
  EXPECT_EQ(queues.entryCount(), 15u);
  EXPECT_THAT(queues.charactersPerCombination(), ElementsAre(1, 1));
}

struct RandomCase {
  Shown shown;
  std::size_t sub_mesh_count = 0;
  std::vector<std::uint32_t> combination_of_character, visible;
};

RandomCase randomCase(std::uint64_t seed) {
  const RandomStream random(seed, 0);
  std::uint64_t draw = 0;
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random.bits(draw++) % limit); };
  RandomCase made;
  made.sub_mesh_count = 1 + below(40);
  made.shown.resize(1 + below(20));
  for (auto& sub_meshes : made.shown) {
    for (std::size_t s = 0; s < made.sub_mesh_count; ++s) {
      if (below(3) == 0) sub_meshes.emplace_back(s);
    }
  }
  made.combination_of_character.resize(below(500));
  for (std::uint32_t i = 0; i < made.combination_of_character.size(); ++i) {
    made.combination_of_character[i] = static_cast<std::uint32_t>(below(made.shown.size()));
    if (below(4) != 0) made.visible.push_back(i);
  }
  return made;
}

TEST(RenderQueues, EqualListsThatAreAppendedTo) {
  RenderQueues queues;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const RandomCase given = randomCase(seed);
    std::vector<std::vector<std::uint32_t>> expected(given.sub_mesh_count);
    for (const std::uint32_t character : given.visible) {
      for (const SubMeshId s : given.shown[given.combination_of_character[character]]) {
        expected[s.value].push_back(character);
      }
    }
    queues.setShown(given.shown, given.sub_mesh_count);
    const auto entries = queues.build(given.combination_of_character, given.visible);
    std::uint32_t sum = 0;
    for (std::size_t s = 0; s < given.sub_mesh_count; ++s) {
      EXPECT_EQ(queues.offsets()[s], sum);
      ASSERT_EQ(queue(queues, entries, s), expected[s]) << "seed " << seed << ", sub-mesh " << s;
      sum += queues.lengths()[s];
    }
    EXPECT_EQ(queues.entryCount(), sum);
    EXPECT_EQ(entries.size(), sum);
  }
}

TEST(RenderQueues, AllIsTheSameAsEveryNumber) {
  const RandomCase given = randomCase(7);
  RenderQueues some, all;
  some.setShown(given.shown, given.sub_mesh_count);
  all.setShown(given.shown, given.sub_mesh_count);
  const auto expected =
      some.build(given.combination_of_character, iota(given.combination_of_character.size()));
  all.countAll(given.combination_of_character);
  std::vector<std::uint32_t> entries(all.entryCount());
  all.fill(entries);
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), entries.begin(), entries.end()));
}

TEST(RenderQueues, AllocateNothingAfterWarmUp) {
  const RandomCase given = randomCase(3);
  ASSERT_FALSE(given.visible.empty());
  RenderQueues queues;
  queues.setShown(given.shown, given.sub_mesh_count);
  queues.build(given.combination_of_character, given.visible);
  const std::size_t before = allocation_count;
  for (std::size_t round = 0; round < 10; ++round) {
    const std::span<const std::uint32_t> visible(given.visible);
    const auto entries = queues.build(given.combination_of_character, visible.subspan(round));
    EXPECT_EQ(entries.size(), queues.entryCount());
  }
  EXPECT_EQ(allocation_count - before, 0u);
  static int* allocated = nullptr;  // the counter counts; static, so that the pair can't be left out
  allocated = new int(0);
  delete allocated;
  EXPECT_EQ(allocation_count - before, 1u);
}

TEST(RenderQueues, WorkWithNobodyAndNothing) {
  RenderQueues queues;
  queues.setShown({}, 0);
  EXPECT_THAT(queues.build({}, {}), IsEmpty());
  queues.setShown(Shown{{}, ids({1})}, 2);
  const std::vector<std::uint32_t> combinations{0, 0, 1};
  EXPECT_THAT(queues.build(combinations, {}), IsEmpty());
  EXPECT_THAT(queues.lengths(), ElementsAre(0, 0));
  EXPECT_THAT(queues.build(combinations, iota(3)), ElementsAre(2));
}

TEST(RenderQueues, CheckTheirCaller) {
  RenderQueues queues;
  EXPECT_THROW(queues.setShown(Shown{ids({2})}, 2), CheckError);
  EXPECT_THROW(queues.setShown(Shown{ids({1, 0})}, 2), CheckError);
  EXPECT_THROW(queues.setShown(Shown{ids({1, 1})}, 2), CheckError);
  queues.setShown(Shown{ids({0}), ids({0, 1})}, 2);
  const std::vector<std::uint32_t> good{0, 1}, bad{0, 2}, twice{1, 1}, descending{1, 0}, beyond{2};
  EXPECT_THROW(queues.count(bad, iota(2)), CheckError);
  EXPECT_THROW(queues.countAll(bad), CheckError);
  EXPECT_THROW(queues.count(good, twice), CheckError);
  EXPECT_THROW(queues.count(good, descending), CheckError);
  EXPECT_THROW(queues.count(good, beyond), CheckError);
  std::vector<std::uint32_t> entries(3);
  EXPECT_THROW(queues.fill(entries), CheckError);  // the last count() failed
  queues.countAll(good);
  EXPECT_EQ(queues.entryCount(), 3u);
  std::vector<std::uint32_t> few(2);
  EXPECT_THROW(queues.fill(few), CheckError);
  queues.fill(entries);
  EXPECT_THAT(entries, ElementsAre(0, 1, 1));
  EXPECT_THROW(queues.fill(entries), CheckError);  // once per count()
}

}  // namespace
}  // namespace ensemble
