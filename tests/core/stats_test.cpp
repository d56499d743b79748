#include "core/stats.h"

#include <gtest/gtest.h>

namespace ensemble {
namespace {

TEST(Stats, QuantilesLieBetweenTheNearestValues) {
  EXPECT_EQ(quantile({7.0}, 0.0), 7.0);
  EXPECT_EQ(quantile({7.0}, 1.0), 7.0);
  // 0, 10, 20, 30, 40 in another order: the share is the place.
  const std::vector<double> values = {30.0, 0.0, 40.0, 10.0, 20.0};
  for (int i = 0; i <= 8; ++i) EXPECT_DOUBLE_EQ(quantile(values, i / 8.0), 5.0 * i);
  EXPECT_EQ(median({4.0, 1.0, 3.0}), 3.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 2.5);
}

}  // namespace
}  // namespace ensemble
