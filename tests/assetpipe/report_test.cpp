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

TEST(Report, OfNoOutfitsIsTheTemplate) {
  const StoredFaces faces = countStoredFaces(100, {});
  EXPECT_EQ(faces.of, (std::array<std::uint64_t, 3>{100, 0, 100}));
  EXPECT_EQ(extrapolateStoredFaces(100, {}, 10).of, (std::array<std::uint64_t, 3>{100, 0, 100}));
}

}  // namespace
}  // namespace ensemble
