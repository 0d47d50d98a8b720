// The one definition of a percentile.
#pragma once

#include <vector>

namespace rilo {

/// Value below which `share` (0 … 1) of the sorted values lie, linear between the two nearest ranks as numpy does; 0.5
/// is the median. 0 without values.
double percentile(const std::vector<double>& sorted, double share);

}  // namespace rilo
