#include "registration/normal_equations.hpp"

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

}  // namespace rilo
