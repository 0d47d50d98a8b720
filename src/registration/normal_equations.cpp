#include "registration/normal_equations.hpp"

#include <cstring>

#include "geometry/wide.hpp"

namespace rilo {

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  H0 += other.H0;
  H1 += other.H1;
  H2 += other.H2;
  b0 += other.b0;
  b1 += other.b1;
  weight += other.weight;
  squared_error += other.squared_error;
  count += other.count;
  return *this;
}

Matrix6d NormalEquations::pose_hessian() const { return H0.selfadjointView<Eigen::Lower>(); }

Matrix12d NormalEquations::hessian() const {
  Matrix12d H;
  const Matrix6d cross = H1.selfadjointView<Eigen::Lower>();
  const Matrix6d velocity = H2.selfadjointView<Eigen::Lower>();
  H << pose_hessian(), cross, cross, velocity;
  return H;
}

Vector12d NormalEquations::gradient() const {
  Vector12d b;
  b << b0, b1;
  return b;
}

void ResidualBlock::flush() {
  sum(rows_.data(), used_, velocity_, sums_);
  used_ = 0;
}

namespace {
using Lanes = float __attribute__((vector_size(8 * sizeof(float))));

/// The first six lanes onto doubles.
inline void add_lanes(const Lanes& lanes, double* to) {
  for (std::size_t i = 0; i < 6; ++i) {
    to[i] += static_cast<double>(lanes[i]);
  }
}
}  // namespace

// Each element is summed over the rows in their order, whatever the width of a register.
RILO_WIDE void ResidualBlock::sum(const Row* rows, std::size_t n, bool velocity, NormalEquations& sums) {
  std::array<Lanes, kRows> wJ;
  std::array<Lanes, kRows> by_s;   // w s J
  std::array<Lanes, kRows> by_s2;  // w s² J
  Lanes b0{};
  Lanes b1{};
  for (std::size_t k = 0; k < n; ++k) {
    const Row& row = rows[k];
    Lanes J;
    std::memcpy(&J, row.J.data(), sizeof(Lanes));
    wJ[k] = row.w * J;
    b0 += row.e * wJ[k];
    if (velocity) {
      by_s[k] = row.s * wJ[k];
      by_s2[k] = row.s * by_s[k];
      b1 += row.e * by_s[k];
    }
  }
  add_lanes(b0, sums.b0.data());
  add_lanes(b1, sums.b1.data());
  for (std::size_t column = 0; column < 6; ++column) {
    const auto c = static_cast<Eigen::Index>(column);
    Lanes h0{};
    Lanes h1{};
    Lanes h2{};
    for (std::size_t k = 0; k < n; ++k) {
      const float J = rows[k].J[column];
      h0 += J * wJ[k];
      if (velocity) {
        h1 += J * by_s[k];
        h2 += J * by_s2[k];
      }
    }
    add_lanes(h0, sums.H0.col(c).data());
    add_lanes(h1, sums.H1.col(c).data());
    add_lanes(h2, sums.H2.col(c).data());
  }
}

}  // namespace rilo
