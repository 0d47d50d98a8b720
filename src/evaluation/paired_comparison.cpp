#include "evaluation/paired_comparison.hpp"

#include <algorithm>
#include <cmath>

namespace rilo {

namespace {

class GeometricMean {
 public:
  void add(double ratio) {
    log_sum_ += std::log(ratio);
    ++count_;
  }
  std::optional<double> value() const {
    return count_ > 0 ? std::optional(std::exp(log_sum_ / static_cast<double>(count_))) : std::nullopt;
  }

 private:
  double log_sum_ = 0;
  std::size_t count_ = 0;
};

// Also NaN is lost.
bool is_lost(const std::optional<double>& figure, double lost_above) { return !figure || !(*figure <= lost_above); }

bool has_ratio(const PairedFigure& pair) {
  const auto positive = [](const std::optional<double>& figure) {
    return figure && *figure > 0.0 && std::isfinite(*figure);
  };
  return positive(pair.ours) && positive(pair.theirs);
}

}  // namespace

PairedComparison compare_pairs(const std::vector<PairedFigure>& pairs, double lost_above) {
  PairedComparison result;
  result.drives = pairs.size();
  GeometricMean tracked;
  GeometricMean all;
  for (const PairedFigure& pair : pairs) {
    const bool ours_lost = is_lost(pair.ours, lost_above);
    const bool theirs_lost = is_lost(pair.theirs, lost_above);
    if (ours_lost) result.lost_by_us.push_back(pair.drive);
    if (theirs_lost) result.lost_by_them.push_back(pair.drive);
    if (ours_lost != theirs_lost) {
      ++(theirs_lost ? result.ahead : result.behind);
    } else if (!ours_lost && *pair.ours != *pair.theirs) {
      ++(*pair.ours < *pair.theirs ? result.ahead : result.behind);
    }
    if (!has_ratio(pair)) continue;
    const double ratio = *pair.ours / *pair.theirs;
    all.add(ratio);
    if (!ours_lost && !theirs_lost) tracked.add(ratio);
    if (!result.worst_ratio || ratio > *result.worst_ratio) {
      result.worst_ratio = ratio;
      result.worst_drive = pair.drive;
    }
  }
  result.mean_ratio = tracked.value();
  result.mean_ratio_all = all.value();
  result.sign_test_p = sign_test_p(result.ahead, result.behind);
  return result;
}

double sign_test_p(std::size_t ahead, std::size_t behind) {
  const auto n = static_cast<double>(ahead + behind);
  const std::size_t fewer = std::min(ahead, behind);
  double tail = 0;
  // Logarithms: 2^n and the binomial coefficients leave the range of a double at a thousand drives.
  for (std::size_t i = 0; i <= fewer; ++i) {
    const auto k = static_cast<double>(i);
    tail += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) - n * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

}  // namespace rilo
