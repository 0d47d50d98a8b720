#include "registration/normal_equations.hpp"

namespace rilo {

namespace {
Matrix6d symmetric(const Matrix6d& lower) { return lower.selfadjointView<Eigen::Lower>(); }
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

Matrix6d NormalEquations::pose_hessian() const { return symmetric(H0); }

Matrix12d NormalEquations::hessian() const {
  Matrix12d H;
  const Matrix6d cross = symmetric(H1);
  H << symmetric(H0), cross, cross, symmetric(H2);
  return H;
}

Vector12d NormalEquations::gradient() const {
  Vector12d b;
  b << b0, b1;
  return b;
}

}  // namespace rilo
