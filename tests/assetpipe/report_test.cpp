#include "assetpipe/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ensemble {
namespace {

/// Lister, Laycock and Day, table 2: garments, pre-fitted total less garments, dedicated.
const std::vector<OutfitFaces> kTable2 = {
    {2486, 5024 - 2486, 259}, {3568, 5739 - 3568, 220}, {2550, 5001 - 2550, 234}};
constexpr std::uint64_t kTable2Template = 3266;

TEST(Report, CountsAsThePapersTable2) {
  const StoredFaces faces = countStoredFaces(kTable2Template, kTable2);
  EXPECT_EQ(faces[Technique::kNaive], 11870u);
  EXPECT_EQ(faces[Technique::kPrefitted], 15764u);
  // The paper prints 12,583; its own columns (3266 + 2745 + 3788 + 2785) add up to 12,584, and the
  // garments plus the dedicated faces to 12,583.
  EXPECT_EQ(faces[Technique::kTagged], 12583u);
}

TEST(Report, ExtrapolatesAsThePapersFigure6) {
  const StoredFaces three = extrapolateStoredFaces(kTable2Template, kTable2, 3);
  EXPECT_EQ(three.of, countStoredFaces(kTable2Template, kTable2).of);
  // Towards many outfits tagged needs 59 % of pre-fitted.
  const StoredFaces many = extrapolateStoredFaces(kTable2Template, kTable2, 100000);
  EXPECT_NEAR(
      static_cast<double>(many[Technique::kTagged]) / static_cast<double>(many[Technique::kPrefitted]), 0.59,
      0.005);
}

TEST(Report, TheCurveIsAStraightLineThroughTheMeanOutfit) {
  const Extrapolation ten = extrapolate(kTable2Template, kTable2, 10);
  ASSERT_EQ(ten.curve.size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    // n times the mean of table 2's columns, rounded.
    const std::uint64_t n = i + 1;
    EXPECT_EQ(ten.curve[i].outfits, n);
    EXPECT_EQ(ten.curve[i].faces[Technique::kNaive], 3266 + (8604 * n + 1) / 3);
    EXPECT_EQ(ten.curve[i].faces[Technique::kPrefitted], (15764 * n + 1) / 3);
    EXPECT_EQ(ten.curve[i].faces[Technique::kTagged], 3266 + (9317 * n + 1) / 3);
  }
  // T / (n p) + t / p, with p and t the means of pre-fitted and tagged outfits.
  const double share = 3266.0 / (10 * 15764.0 / 3) + 9317.0 / 15764.0;
  EXPECT_NEAR(ten.curve.back().tagged_vs_prefitted.value(), share, 1e-5);
  EXPECT_DOUBLE_EQ(ten.limit.value(), 9317.0 / 15764.0);
}

TEST(Report, ALongCurveIsThinnedAndKeepsItsEnds) {
  const auto countsTo = [](std::uint64_t last) {
    std::vector<std::uint64_t> counts;
    for (const ExtrapolatedFaces& at : extrapolate(kTable2Template, kTable2, last).curve)
      counts.push_back(at.outfits);
    return counts;
  };
  EXPECT_EQ(countsTo(1), (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(countsTo(2), (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(countsTo(100).size(), 100u);
  const std::vector<std::uint64_t> many = countsTo(1000000);
  ASSERT_EQ(many.size(), 101u) << "a hundred places, and the three outfits that were counted";
  EXPECT_EQ(many[0], 1u);
  EXPECT_EQ(many[1], 3u);
  EXPECT_EQ(many[2], 10102u);
  EXPECT_EQ(many.back(), 1000000u);
}

TEST(Report, OfNoOutfitsIsTheTemplate) {
  const StoredFaces faces = countStoredFaces(100, {});
  EXPECT_EQ(faces.of, (std::array<std::uint64_t, 3>{100, 0, 100}));
  EXPECT_EQ(extrapolateStoredFaces(100, {}, 10).of, (std::array<std::uint64_t, 3>{100, 0, 100}));
}

}  // namespace
}  // namespace ensemble
