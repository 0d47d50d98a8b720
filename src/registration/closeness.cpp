#include "registration/closeness.hpp"

#include <cmath>

namespace rilo {

namespace {
struct Sums {
  double count = 0;
  double weight = 0;
  double squares = 0;  // weighted

  Sums& operator+=(const Sums& other) {
    count += other.count;
    weight += other.weight;
    squares += other.squares;
    return *this;
  }
};
}  // namespace

Closeness closeness(const RegisteredSource& sweep, const LocalMap& map) {
  const auto sums = sum_of_residuals<Sums>(sweep, map, [](Sums& sum, const PlaneResidual& residual) {
    sum += {1.0, residual.weight, residual.weight * residual.distance_m * residual.distance_m};
  });
  if (sums.weight <= 0.0) {
    return {};
  }
  return {sums.count / static_cast<double>(sweep.used()), std::sqrt(sums.squares / sums.weight)};
}

}  // namespace rilo
