#include <algorithm>
#include <cmath>

#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

ErrorSummary summarise(std::vector<double> errors) {
  ErrorSummary summary;
  summary.count = errors.size();
  if (errors.empty()) return summary;
  const auto n = static_cast<double>(errors.size());
  double sum = 0;
  double sum_of_squares = 0;
  for (const double e : errors) {
    sum += e;
    sum_of_squares += e * e;
  }
  summary.mean = sum / n;
  summary.rmse = std::sqrt(sum_of_squares / n);
  double variance = 0;  // in a second pass: rmse² − mean² cancels when the errors are nearly equal
  for (const double e : errors) variance += (e - summary.mean) * (e - summary.mean) / n;
  summary.std = std::sqrt(variance);
  std::sort(errors.begin(), errors.end());
  const std::size_t middle = errors.size() / 2;
  summary.median = errors.size() % 2 == 1 ? errors[middle] : 0.5 * (errors[middle - 1] + errors[middle]);
  summary.max = errors.back();
  return summary;
}

}  // namespace rilo
