#include "registration/normal_equations.hpp"

#include <cstring>

#include "geometry/wide.hpp"

namespace rilo {

namespace {
Matrix6d unpacked(const PackedSymmetric6& h) {
  Matrix6d lower = Matrix6d::Zero();
  lower.col(0) = h.segment<6>(0);
  lower.col(1) = h.segment<6>(6);
  lower.col(2).tail<4>() = h.segment<4>(12);
  lower.col(3).tail<4>() = h.segment<4>(16);
  lower.col(4).tail<2>() = h.segment<2>(20);
  lower.col(5).tail<2>() = h.segment<2>(22);
  return lower.selfadjointView<Eigen::Lower>();
}
}  // namespace

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

Matrix6d NormalEquations::pose_hessian() const { return unpacked(H0); }

Matrix12d NormalEquations::hessian() const {
  Matrix12d H;
  const Matrix6d cross = unpacked(H1);
  H << unpacked(H0), cross, cross, unpacked(H2);
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

// Each element is summed over the rows in their order, whatever the width of a register.
RILO_WIDE void ResidualBlock::sum(const Row* rows, std::size_t n, bool velocity, NormalEquations& sums) {
  using Lanes = double __attribute__((vector_size(4 * sizeof(double))));
  constexpr Eigen::Index kLanes = sizeof(Lanes) / sizeof(double);
  static_assert(PackedSymmetric6::SizeAtCompileTime % kLanes == 0);
  for (Eigen::Index first = 0; first < PackedSymmetric6::SizeAtCompileTime; first += kLanes) {
    Lanes h0;
    std::memcpy(&h0, &sums.H0[first], sizeof(Lanes));
    for (std::size_t k = 0; k < n; ++k) {
      Lanes h;
      std::memcpy(&h, &rows[k].h[first], sizeof(Lanes));
      h0 += h;
    }
    std::memcpy(&sums.H0[first], &h0, sizeof(Lanes));
    if (!velocity) {
      continue;
    }
    Lanes h1;
    Lanes h2;
    std::memcpy(&h1, &sums.H1[first], sizeof(Lanes));
    std::memcpy(&h2, &sums.H2[first], sizeof(Lanes));
    for (std::size_t k = 0; k < n; ++k) {
      const double s = rows[k].s;
      Lanes h;
      std::memcpy(&h, &rows[k].h[first], sizeof(Lanes));
      h1 += s * h;
      h2 += s * s * h;
    }
    std::memcpy(&sums.H1[first], &h1, sizeof(Lanes));
    std::memcpy(&sums.H2[first], &h2, sizeof(Lanes));
  }
  for (std::size_t k = 0; k < n; ++k) {
    sums.b0 += rows[k].e * rows[k].wJ;
    sums.b1 += rows[k].s * rows[k].e * rows[k].wJ;
  }
}

}  // namespace rilo
