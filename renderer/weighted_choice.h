// Chooses among things by weight.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ensemble {

/// Chooses a number with a probability in proportion to its weight; one of weight 0 never.
class WeightedChoice {
 public:
  void add(float weight) {
    sums_.push_back(total() + static_cast<double>(weight));
    if (weight > 0.0f) last_possible_ = sums_.size() - 1;
  }
  double total() const { return sums_.empty() ? 0.0 : sums_.back(); }
  std::size_t size() const { return sums_.size(); }

  /// @param u in [0, 1). @pre total() > 0
  std::size_t choose(double u) const {
    // The first sum beyond u: an entry of weight 0 has the sum of the one before it.
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), u * total());
    return std::min(static_cast<std::size_t>(found - sums_.begin()), last_possible_);
  }

 private:
  std::vector<double> sums_;
  std::size_t last_possible_ = 0;
};

}  // namespace ensemble
