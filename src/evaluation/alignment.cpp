#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "rilo/evaluation/pose_error.hpp"

namespace rilo {

namespace {

// Squared ratio of extents below which positions count as a straight line (0.1 mm aside over 100 m) or as one point.
constexpr double kDegenerate = 1e-12;

using Svd = Eigen::JacobiSVD<Eigen::Matrix3d>;
constexpr unsigned int kFull = Eigen::ComputeFullU | Eigen::ComputeFullV;

/// The rotation R that maximises trace(Rᵀ M) for the decomposed M (Kabsch).
Eigen::Matrix3d nearest_rotation(const Svd& svd) {
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

/// The rotation about the unit vector `axis` that brings the rotations summed up in N = Σ R_truth (R R_estimate)ᵀ
/// together.
Eigen::Matrix3d best_turn_about(const Eigen::Vector3d& axis, const Eigen::Matrix3d& N) {
  const double cosine = N.trace() - axis.dot(N * axis);
  const double sine = (hat(axis).transpose() * N).trace();
  const double angle = std::hypot(cosine, sine) > 0.0 ? std::atan2(sine, cosine) : 0.0;
  return so3_exp(angle * axis);
}

Eigen::Vector3d mean_position(const std::vector<SE3>& poses) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SE3& T : poses) sum += T.translation();
  return sum / static_cast<double>(poses.size());
}

void check_finite(const std::vector<SE3>& poses, const char* name) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].matrix().allFinite()) {
      throw std::invalid_argument("pose " + std::to_string(i) + " of the " + name + " is not finite");
    }
  }
}

}  // namespace

void check_trajectories(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
  if (truth.size() != estimate.size()) {
    throw std::invalid_argument("trajectories differ in length: truth has " + std::to_string(truth.size()) +
                                " poses, estimate has " + std::to_string(estimate.size()));
  }
  if (truth.size() < 2) {
    throw std::invalid_argument("an evaluation needs at least two poses, found " + std::to_string(truth.size()));
  }
  check_finite(truth, "truth");
  check_finite(estimate, "estimate");
}

SE3 align_umeyama(const std::vector<SE3>& truth, const std::vector<SE3>& estimate) {
  check_trajectories(truth, estimate);
  const Eigen::Vector3d mean_truth = mean_position(truth);
  const Eigen::Vector3d mean_estimate = mean_position(estimate);
  Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d orientations = Eigen::Matrix3d::Zero();
  double scale = 0;  // of the positions, to tell a sensor at rest from a small trajectory
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Eigen::Vector3d x = estimate[i].translation() - mean_estimate;
    const Eigen::Vector3d y = truth[i].translation() - mean_truth;
    M += y * x.transpose();
    orientations += truth[i].linear() * estimate[i].linear().transpose();
    scale += truth[i].translation().squaredNorm() + estimate[i].translation().squaredNorm();
  }
  const Svd svd(M, kFull);
  const Eigen::Vector3d& extent = svd.singularValues();
  Eigen::Matrix3d R = nearest_rotation(svd);
  if (extent(0) <= 1e-24 * scale) {
    R = nearest_rotation(Svd(orientations, kFull));
  } else if (extent(1) <= kDegenerate * extent(0)) {
    R = best_turn_about(svd.matrixU().col(0), orientations * R.transpose()) * R;
  }
  SE3 T_truth_estimate = SE3::Identity();
  T_truth_estimate.linear() = R;
  T_truth_estimate.translation() = mean_truth - R * mean_estimate;
  return T_truth_estimate;
}

SE3 alignment_of(const std::vector<SE3>& truth, const std::vector<SE3>& estimate, Alignment alignment) {
  check_trajectories(truth, estimate);
  switch (alignment) {
    case Alignment::kFirstPose:
      // The general inverse: rotations read from text are not quite orthonormal, and equal first poses must give
      // identity.
      return SE3(truth.front() * estimate.front().inverse(Eigen::Affine));
    case Alignment::kUmeyama:
      return align_umeyama(truth, estimate);
    case Alignment::kNone:
      break;
  }
  return SE3::Identity();
}

std::vector<SE3> moved(const std::vector<SE3>& poses, const SE3& T) {
  std::vector<SE3> result;
  result.reserve(poses.size());
  for (const SE3& pose : poses) result.push_back(T * pose);
  return result;
}

std::vector<double> path_lengths(const std::vector<SE3>& poses) {
  std::vector<double> lengths(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths[i] = lengths[i - 1] + (poses[i].translation() - poses[i - 1].translation()).norm();
  }
  return lengths;
}

}  // namespace rilo
