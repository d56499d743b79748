#include "core/stats.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace ensemble {

double quantile(std::vector<double> values, double share) {
  ENSEMBLE_CHECK(!values.empty());
  ENSEMBLE_CHECK(share >= 0.0 && share <= 1.0);
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  if (below + 1 == values.size()) return values[below];
  return std::lerp(values[below], values[below + 1], position - std::floor(position));
}

}  // namespace ensemble
