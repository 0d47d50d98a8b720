#include "calibration/elevation_offset.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "cloud/elevation.hpp"
#include "geometry/degrees.hpp"
#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {

constexpr std::size_t kSweepsPerBlock = 5;  // half a second: the map's errors are shared by neighbouring sweeps
constexpr std::size_t kLeastBlocks = 3;     // for a standard deviation
// Noise in the Jacobians weakens the response to about this share of the ideal one; chosen on drives with an offset. It
// sets the rate of convergence, not the limit: there the gradient is zero.
constexpr double kResponse = 0.5;
// Error common to all residuals of a surface, whatever their number: errors of single beams, rounded edges.
constexpr double kSystematicM = 0.002;

/// Sums of the mixed terms of δ with pose and velocity, and of δ alone.
struct Sums {
  Vector12d mixed = Vector12d::Zero();
  double square = 0;
  double gradient = 0;
  double weight = 0;

  void operator+=(const Sums& other) {
    mixed += other.mixed;
    square += other.square;
    gradient += other.gradient;
    weight += other.weight;
  }
};

Sums sums_of(const RegisteredSource& sweep, const LocalMap& map, const PoseDerivative& last, bool refine) {
  const Eigen::Matrix3d R = sweep.state.T_odom_lidar.linear();
  const Eigen::Vector3d t = sweep.state.T_odom_lidar.translation();
  return sum_of_residuals<Sums>(sweep, map, [&](Sums& sum, const PlaneResidual& residual) {
    const auto& [i, sensor, world, spot, plane, e, w] = residual;
    // Relative to a sensor that continues to move with δ as the last pose did; the whole plane moves, so that its own
    // point counts.
    const Eigen::Vector3d moves = R * elevation_jacobian(sensor).cast<double>() + last.at(plane.point) -
                                  spot.grid->elevation_jacobian_at(spot).cast<double>();
    const double c = plane.normal.dot(moves);  // ∂e/∂δ
    Vector6d J;
    J << (world - t).cross(plane.normal), plane.normal;
    sum.mixed.head<6>() += w * c * J;
    if (refine) {
      sum.mixed.tail<6>() += (w * c * sweep.state.velocity_lever_s(static_cast<double>(sweep.source.offsets_s[i]))) * J;
    }
    sum.square += w * c * c;
    sum.gradient -= w * c * e;
    sum.weight += w;
  });
}

}  // namespace

ElevationInformation elevation_information(const TimedCloud& source, const LocalMap& map, const IcpResult& icp,
                                           double sigma_th_m, const AdaptiveIcpConfig& config,
                                           const PoseDerivative& last, std::size_t stride) {
  const Eigen::Vector3d t = icp.state.T_odom_lidar.translation();
  const RegisteredSource sweep{source, icp.state, sigma_th_m, config.gate * sigma_th_m, stride};
  const Sums total = sums_of(sweep, map, last, source.timed() && config.refine_motion);
  ElevationInformation result;
  result.pose = {t, last.rotation, last.at(t)};
  if (!(total.weight > 0.0)) {
    return result;
  }
  // As in the posterior: with a scale of its own the pose could explain more than there is.
  const double scale = static_cast<double>(stride) * icp.unit_information;
  // At the registered pose the gradient of pose and velocity is zero: the complement changes the information alone.
  const Vector12d solved = icp.posterior_information.ldlt().solve(scale * total.mixed);
  const double information = scale * total.square - scale * total.mixed.dot(solved);
  if (!std::isfinite(information) || information <= 0.0) {
    return result;
  }
  const double jacobian2 = information / (scale * total.weight);
  return {information,
          scale * total.gradient,
          std::sqrt(jacobian2),
          {t, last.rotation - solved.head<3>(), last.at(t) - solved.segment<3>(3)}};
}

ElevationOffsetEstimator::ElevationOffsetEstimator(const ElevationOffsetConfig& config)
    : config_(config), applied_rad_(config.initial_deg * kRadPerDeg) {}

void ElevationOffsetEstimator::add(const ElevationInformation& sweep) {
  if (!(sweep.information > 0.0)) {
    return;
  }
  // Information gathered at another applied angle counts less, since the response is not exactly known: the memory
  // grows with the drive, and its last third counts most.
  const double n = static_cast<double>(++sweeps_);
  const double keep = (n - 1.0) * (n - 1.0) / (n * n);
  for (double* sum : {&information_, &weighted_offset_, &block_information_, &block_offset_, &squares_, &jacobian2_}) {
    *sum *= keep;
  }
  squared_information_ *= keep * keep;
  jacobian2_ += sweep.information * sweep.jacobian_m * sweep.jacobian_m;
  const double weighted = sweep.information * applied_rad_ + sweep.gradient / kResponse;
  information_ += sweep.information;
  weighted_offset_ += weighted;
  block_information_ += sweep.information;
  block_offset_ += weighted;
  if (++in_block_ == kSweepsPerBlock) {
    const double mean = block_offset_ / block_information_;
    squares_ += block_information_ * mean * mean;
    squared_information_ += block_information_ * block_information_;
    ++blocks_;
    block_information_ = 0.0;
    block_offset_ = 0.0;
    in_block_ = 0;
  }
}

AngleEstimate ElevationOffsetEstimator::of_sweeps() const {
  return {information_ > 0.0 ? weighted_offset_ / information_ : applied_rad_, sigma_of_sweeps_rad()};
}

// Scatter of blocks of sweeps.
double ElevationOffsetEstimator::sigma_of_sweeps_rad() const {
  if (blocks_ < kLeastBlocks) {
    return std::numeric_limits<double>::infinity();
  }
  const double done = information_ - block_information_;
  const double mean = (weighted_offset_ - block_offset_) / done;
  const double scatter = std::max(0.0, squares_ / done - mean * mean);
  // Weighted mean of independent blocks: its variance is the scatter over the effective number of blocks less one.
  const double effective = done * done / squared_information_;
  const double from_scatter = scatter / std::max(1.0, effective - 1.0);
  const double systematic = kSystematicM * kSystematicM * information_ / jacobian2_;
  return std::sqrt(std::max(from_scatter, 1.0 / information_) + systematic);
}

AngleEstimate ElevationOffsetEstimator::estimate() const {
  const AngleEstimate own = of_sweeps();
  if (!std::isfinite(others_.sigma_rad)) {
    return own;
  }
  if (!std::isfinite(own.sigma_rad)) {
    return others_;
  }
  const double own_weight = 1.0 / (own.sigma_rad * own.sigma_rad);
  const double weight = 1.0 / (others_.sigma_rad * others_.sigma_rad);
  return {(own_weight * own.rad + weight * others_.rad) / (own_weight + weight), 1.0 / std::sqrt(own_weight + weight)};
}

// The sensor may have been put right since, or be another unit.
void ElevationOffsetEstimator::doubt_others() {
  const AngleEstimate own = of_sweeps();
  if (std::abs(own.rad - others_.rad) > config_.significance * std::hypot(own.sigma_rad, others_.sigma_rad)) {
    others_ = {};
  }
}

void ElevationOffsetEstimator::decide() {
  const auto [angle, sigma] = estimate();
  const double enough = config_.significance * sigma;
  following_ = following_ || std::abs(angle) > enough || std::abs(angle - config_.initial_deg * kRadPerDeg) > enough;
}

double ElevationOffsetEstimator::known_deg() const {
  return config_.enabled && following_ ? kDegPerRad * estimate().rad : config_.initial_deg;
}

void ElevationOffsetEstimator::begin_with(double initial_deg, const AngleEstimate& others) {
  ElevationOffsetConfig config = config_;
  config.initial_deg = initial_deg;
  const AngleEstimate kept = others;  // may be our own
  *this = ElevationOffsetEstimator(config);
  others_ = kept;
}

double ElevationOffsetEstimator::advance() {
  doubt_others();
  decide();
  if (!config_.enabled || !following_) {
    return 0.0;
  }
  const double change = estimate().rad - applied_rad_;
  applied_rad_ += change;
  return change;
}

}  // namespace rilo
