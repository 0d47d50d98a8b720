// Residuals of points against the planes of the map, and their normal equations.
#include <algorithm>
#include <cmath>

#include "cloud/fixed_chunks.hpp"
#include "rilo/cloud/deskew.hpp"
#include "rilo/registration/adaptive_icp.hpp"

namespace rilo {

namespace {

constexpr std::size_t kNoiseStride = 8;  // a sample of the points tells the noise of the normals

/// Covariance of a Jacobian [(p × n)ᵀ nᵀ] whose normal has the given one.
Matrix6d jacobian_noise(const Eigen::Vector3d& p, const Eigen::Matrix3d& normal_covariance) {
  Eigen::Matrix<double, 6, 3> by_normal;
  by_normal << hat(p), Eigen::Matrix3d::Identity();
  return by_normal * normal_covariance * by_normal.transpose();
}

}  // namespace

void PlaneMatches::begin(const TimedCloud& source, const MotionState& state, std::size_t stride, std::size_t count) {
  if (stride_ == 0) {
    measure(source);
  }
  matches_.assign(count, Match{});
  stride_ = stride;
  state_ = state;
}

void PlaneMatches::measure(const TimedCloud& source) {
  double sum = 0.0;
  for (const Eigen::Vector3f& p : source.points) {
    sum += static_cast<double>(p.norm());
  }
  lever_m_ = source.points.empty() ? 0.0 : sum / static_cast<double>(source.size());
  half_span_s_ = 0.0;
  for (const float offset : source.offsets_s) {
    half_span_s_ = std::max(half_span_s_, static_cast<double>(std::abs(offset)));
  }
}

bool PlaneMatches::near(const MotionState& state) const {
  // How far a typical point has moved: with the pose, and at either end of the sweep with the velocity.
  const SE3 moved = state_.T_odom_lidar.inverse() * state.T_odom_lidar;
  const Vector6d rate = state.twist - state_.twist;
  const double turned_rad = so3_log(moved.linear()).norm() + half_span_s_ * rate.head<3>().norm();
  return moved.translation().norm() + half_span_s_ * rate.tail<3>().norm() + lever_m_ * turned_rad < rematch_m_;
}

NormalEquations PlaneMatches::linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state,
                                        double sigma_th_m, const AdaptiveIcpConfig& config, std::size_t stride) {
  const bool refine = source.timed() && config.refine_motion;
  const Eigen::Matrix3d R = state.T_odom_lidar.linear();
  const Eigen::Vector3d t = state.T_odom_lidar.translation();
  const SweepMotion motion = SweepMotion::during(source, state.twist);
  const double gate = config.adaptive ? config.gate * sigma_th_m : config.fixed_gate_m;
  const double sigma2 = sigma_th_m * sigma_th_m;
  const std::size_t count = (source.size() + stride - 1) / stride;
  const bool keep = stride == stride_ && count == matches_.size() && near(state);
  if (!keep) {
    begin(source, state, stride, count);
  }
  std::vector<NormalEquations> partial(chunk_count(count));
  std::vector<Matrix6d> noise(keep ? 0 : chunk_count(count), Matrix6d::Zero());
  for_fixed_chunks(count, [&](std::size_t chunk, std::size_t first, std::size_t last) {
    NormalEquations sum;
    const auto point_at = [&](std::size_t k) -> Eigen::Vector3d {
      return R * motion.compensated(source, k * stride).cast<double>() + t;
    };
    // Adds a point to the equations; returns its weight.
    const auto add = [&](std::size_t k, const Eigen::Vector3d& world) {
      const Match& match = matches_[k];
      const double e = match.normal.dot(world) - match.distance;  // e_k = (p_k − q_k)·n_k
      if (std::abs(e) > gate) {
        return 0.0;
      }
      const double beta = config.adaptive ? sigma2 / (sigma2 + e * e) : 1.0;  // β_k
      Vector6d J;                                                             // [(p × n)ᵀ nᵀ]
      J << (world - t).cross(match.normal), match.normal;
      if (refine) {
        sum.add(J, e, beta, static_cast<double>(source.offsets_s[k * stride]));
      } else {
        sum.add(J, e, beta);
      }
      return beta;
    };
    if (keep) {
      for (std::size_t k = first; k < last; ++k) {
        if (matches_[k].found) {
          add(k, point_at(k));
        }
      }
    } else {
      map.visit(first, last, point_at, [&](std::size_t k, const Eigen::Vector3d& world, const PlaneSpot& spot) {
        const MapPlane plane = spot.grid->plane_at(spot);
        matches_[k] = {plane.normal, plane.normal.dot(plane.point), true};
        const double beta = add(k, world);
        if (k % kNoiseStride == 0 && beta > 0.0) {
          noise[chunk] += beta * jacobian_noise(world - t, spot.grid->normal_covariance_at(spot));
        }
      });
    }
    partial[chunk] = sum;
  });
  if (!keep) {
    normal_noise_.setZero();
    for (const Matrix6d& part : noise) {
      normal_noise_ += static_cast<double>(kNoiseStride) * part;
    }
  }
  NormalEquations total;
  for (const NormalEquations& sum : partial) {
    total += sum;
  }
  return total;
}

NormalEquations linearise(const TimedCloud& source, const LocalMap& map, const MotionState& state, double sigma_th_m,
                          const AdaptiveIcpConfig& config, std::size_t stride) {
  return PlaneMatches(0.0).linearise(source, map, state, sigma_th_m, config, stride);
}

}  // namespace rilo
