#include "renderer/raster_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>

namespace ensemble {
namespace {

/// Three items in two meshes, of which combination 0 shows 0 and 2, combination 1 shows 1 and 2.
RasterPlan smallPlan() {
  const auto item = [](std::uint32_t mesh, std::uint32_t state, std::uint32_t first_index,
                       std::uint32_t triangles) {
    GpuRasterWork work{};
    work.first_index = first_index;
    work.triangle_count = triangles;
    work.material = 100 + first_index;
    return PlanItem{mesh, state, work};
  };
  return RasterPlan({item(0, 0, 0, 10), item(0, 0, 30, 3), item(1, 1, 39, 17)},
                    {{{0, 0}, {2, 10}}, {{1, 0}, {2, 3}}}, 8);
}

PlanPose poseAt(std::uint32_t mesh, std::uint32_t key) { return {0, 1000 * mesh + 10 * key}; }

TEST(RasterPlan, EveryTriangleOfEveryoneOnce) {
  RasterPlan plan = smallPlan();
  EXPECT_EQ(plan.faceBits(), 5u) << "27 faces at most";
  const std::vector<PlanPerson> people = {{0, 2}, {1, 2}, {0, 1}, {0, 2}, {1, 0}};
  plan.arrange(people, 4, plan.faceBits());
  plan.place(poseAt);
  std::set<std::tuple<std::uint32_t, std::uint32_t>> drawn;  // id and index of the triangle's first corner
  std::map<std::uint32_t, std::set<std::uint32_t>> poses_of_person;
  std::uint32_t groups = 0;
  for (const PlanBatch& batch : plan.batches()) {
    EXPECT_EQ(batch.first_group, groups);
    groups += batch.group_count;
    for (std::uint32_t g = batch.first_group; g < groups; ++g) {
      const GpuRasterGroup& group = plan.groups()[g];
      const GpuRasterWork& work = plan.work()[group.work];
      EXPECT_EQ(batch.state, work.first_index == 39 ? 1u : 0u);
      EXPECT_EQ(work.material, 100 + work.first_index);
      const std::uint32_t end = std::min(group.first_triangle + 8, work.triangle_count);
      for (std::uint32_t t = group.first_triangle; t < end; ++t) {
        for (std::uint32_t e = 0; e < work.entry_count; ++e) {
          const std::uint32_t entry = plan.entries()[work.first_entry + e];
          EXPECT_TRUE(drawn.emplace(entry + t, work.first_index + 3 * t).second) << "twice";
          poses_of_person[entry >> plan.faceBits()].insert(work.pose % 1000);
        }
      }
    }
  }
  EXPECT_EQ(groups, plan.groups().size());
  EXPECT_EQ(drawn.size(), 3u * 27u + 2u * 20u);
  EXPECT_EQ(plan.triangleCount(), drawn.size());
  std::set<std::uint32_t> ids;
  for (const auto& [id, corner] : drawn) EXPECT_TRUE(ids.insert(id).second) << "ids tell all apart";
  for (std::uint32_t p = 0; p < people.size(); ++p)
    EXPECT_THAT(poses_of_person[p], ::testing::ElementsAre(10 * people[p].key)) << p;
}

TEST(RasterPlan, PeopleOfOnePoseAreDrawnTogether) {
  RasterPlan plan = smallPlan();
  const std::vector<PlanPerson> people = {{0, 2}, {1, 2}, {0, 2}, {0, 1}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> asked;
  plan.arrange(people, 4, plan.faceBits());
  plan.place([&](std::uint32_t mesh, std::uint32_t key) {
    ++asked[{mesh, key}];
    return poseAt(mesh, key);
  });
  ASSERT_EQ(plan.work().size(), 5u) << "items 0, 1, 2 at key 2, items 0, 2 at key 1";
  for (const GpuRasterWork& work : plan.work()) {
    if (work.pose % 1000 != 20) continue;
    EXPECT_EQ(work.entry_count, work.first_index == 0 ? 2u : work.first_index == 30 ? 1u : 3u);
  }
  EXPECT_EQ(asked.size(), 4u);
}

// Whoever is of the second round has groups of its own, behind the others, and room for each that may be
// picked.
TEST(RasterPlan, TheSecondRoundComesLast) {
  RasterPlan plan = smallPlan();
  const std::vector<PlanPerson> people = {
      {0, 2, true}, {1, 2, false}, {0, 1, true}, {0, 2, false}, {1, 0, true}};
  plan.arrange(people, 4, plan.faceBits());
  plan.place(poseAt);
  ASSERT_TRUE(plan.hasSecondRound());
  std::uint64_t triangles = 0, entries = 0;
  std::set<std::pair<std::uint32_t, std::uint32_t>> picked;
  for (std::uint32_t b = 0; b < plan.batches().size(); ++b) {
    const PlanBatch& batch = plan.batches()[b];
    EXPECT_EQ(batch.is_late, batch.first_group >= plan.firstLateGroup());
    for (std::uint32_t g = batch.first_group; g < batch.first_group + batch.group_count; ++g) {
      const GpuRasterGroup& group = plan.groups()[g];
      const GpuRasterWork& work = plan.work()[group.work];
      EXPECT_EQ(work.batch, b);
      const std::uint32_t first = work.first_picked + group.first_triangle / 8 * group.entry_count;
      for (std::uint32_t e = 0; e < group.entry_count; ++e) {
        const std::uint32_t person = plan.entries()[group.first_entry + e] >> plan.faceBits();
        EXPECT_EQ(people[person].is_late, batch.is_late);
        if (!batch.is_late) continue;
        EXPECT_GE(first + e, plan.entries().size());
        EXPECT_TRUE(picked.emplace(first + e, g).second);
        ++entries;
        triangles += std::min(8u, work.triangle_count - group.first_triangle);
      }
    }
  }
  EXPECT_EQ(entries, plan.pickedCount());
  EXPECT_EQ(picked.rbegin()->first + 1, plan.entries().size() + plan.pickedCount());
  EXPECT_EQ(triangles, plan.lateTriangleCount());
  EXPECT_EQ(plan.triangleCount(), 3u * 27u + 2u * 20u);
  plan.arrange({people.data(), 0}, 4, plan.faceBits());
  plan.place(poseAt);
  EXPECT_FALSE(plan.hasSecondRound());
}

TEST(RasterPlan, NobodyIsNoWork) {
  RasterPlan plan = smallPlan();
  plan.arrange(std::vector<PlanPerson>{{0, 1}}, 4, plan.faceBits());
  plan.place(poseAt);
  plan.arrange({}, 4, plan.faceBits());
  plan.place(poseAt);
  EXPECT_TRUE(plan.groups().empty());
  EXPECT_TRUE(plan.batches().empty());
  EXPECT_EQ(plan.triangleCount(), 0u);
}

}  // namespace
}  // namespace ensemble
