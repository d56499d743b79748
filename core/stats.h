// Order statistics of a few measurements.
#pragma once

#include <vector>

namespace ensemble {

/// The value below which `share` of the values lie, interpolated linearly between the two nearest
/// (R's type 7, NumPy's default): share 0 is the least, 0.5 the median, 1 the greatest.
/// @pre there is a value, none is NaN, and 0 <= share <= 1
double quantile(std::vector<double> values, double share);

inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace ensemble
