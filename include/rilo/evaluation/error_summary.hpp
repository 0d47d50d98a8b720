// Statistics of a list of errors.
#pragma once

#include <cstddef>
#include <vector>

namespace rilo {

/// Statistics in the unit of the errors. rmse² = mean² + std² (population standard deviation, as evo and numpy do).
/// All zero when there is no error (count = 0).
struct ErrorSummary {
  std::size_t count = 0;
  double rmse = 0;
  double mean = 0;
  double std = 0;
  double median = 0;  ///< mean of the two middle values when count is even
  double max = 0;
};

/// Statistics of `errors` (finite, any order).
ErrorSummary summarise(std::vector<double> errors);

}  // namespace rilo
