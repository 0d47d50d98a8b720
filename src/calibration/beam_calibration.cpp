#include "calibration/beam_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/LU>

#include "registration/plane_residuals.hpp"

namespace rilo {

namespace {

constexpr double kMemorySweeps = 100.0;  // the mean information follows the place, not the single sweep
// Prior towards zero, in the unit of the information of one beam and sweep (sum of squared Jacobians, m²): a beam with
// fewer or nearer points hardly moves.
constexpr double kPriorInformation = 50.0;
constexpr double kHalfWeightInformation = 150.0;  // m²: with this much a beam has weight ½
constexpr double kNeighbourhood = 0.052;          // tangent: 3°, the neighbours of a beam
constexpr std::size_t kFewestNeighbours = 5;      // itself included: their mean is steadier than the beam

}  // namespace

void BeamCalibration::learn(const BeamSample& sample, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
                            const AdaptiveIcpConfig& config) {
  observe(sample, map, icp, sigma_th_m, config);
  sum_up(sample);
  find_steps();
  apply_differences();
}

void BeamCalibration::observe(const BeamSample& sample, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
                              const AdaptiveIcpConfig& config) {
  observations_.assign(sample.cloud.size(), Observation{});
  const Eigen::Matrix3d to_sensor = icp.state.T_odom_lidar.linear().transpose();
  const RegisteredSource sweep{sample.cloud, icp.state, sigma_th_m, config};
  for_each_residual(sweep, map, [&](std::size_t /*chunk*/, const PlaneResidual& residual) {
    if (sample.beams[residual.index] >= kBeams) {
      return;
    }
    const Eigen::Vector3d normal = to_sensor * residual.plane.normal;
    observations_[residual.index] = {{normal.dot(elevation_jacobian(residual.sensor).cast<double>()),
                                      normal.dot(azimuth_jacobian(residual.sensor).cast<double>())},
                                     residual.distance_m,
                                     residual.weight};
  });
}

void BeamCalibration::sum_up(const BeamSample& sample) {
  for (Information& beam : beams_) {
    beam.sweep.setZero();
    beam.gradient.setZero();
  }
  in_order_.clear();
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    const Observation& seen = observations_[i];
    const Eigen::Vector3f& p = sample.cloud.points[i];
    if (!(seen.weight > 0.0) || p.head<2>().isZero(0.0F)) {
      continue;  // on the axis a point has no azimuth
    }
    Information& beam = beams_[sample.beams[i]];
    beam.sweep += seen.weight * seen.jacobian * seen.jacobian.transpose();
    beam.gradient -= seen.weight * seen.residual_m * seen.jacobian;
    beam.points += 1.0;
    beam.tangent += (static_cast<double>(p.z() / p.head<2>().norm()) - beam.tangent) / beam.points;
  }
  for (std::size_t b = 0; b < kBeams; ++b) {
    if (beams_[b].points > 0.0) {
      in_order_.push_back(static_cast<Beam>(b));
    }
  }
  sort_by_elevation(in_order_);
}

void BeamCalibration::sort_by_elevation(std::vector<Beam>& beams) const {
  std::sort(beams.begin(), beams.end(), [&](Beam a, Beam b) { return beams_[a].tangent < beams_[b].tangent; });
}

void BeamCalibration::find_steps() {
  sweeps_ = std::min(sweeps_ + 1.0, kMemorySweeps);
  for (const Beam b : in_order_) {
    Information& beam = beams_[b];
    beam.mean += (beam.sweep - beam.mean) / sweeps_;
    const Eigen::Matrix2d information = beam.mean + kPriorInformation * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d angles = angles_.of(b).cast<double>();
    steps_[b] = config_.gain * information.inverse() * (beam.gradient - kPriorInformation * angles);
  }
}

void BeamCalibration::apply_differences() {
  std::size_t first = 0;
  for (const Beam b : in_order_) {
    const double tangent = beams_[b].tangent;
    while (beams_[in_order_[first]].tangent < tangent - kNeighbourhood) {
      ++first;
    }
    Eigen::Array2d sum = Eigen::Array2d::Zero();
    Eigen::Array2d total = Eigen::Array2d::Zero();
    std::size_t neighbour = first;
    for (; neighbour < in_order_.size(); ++neighbour) {
      const Information& other = beams_[in_order_[neighbour]];
      if (other.tangent > tangent + kNeighbourhood) {
        break;
      }
      const Eigen::Array2d seen = other.mean.diagonal().array();
      const Eigen::Array2d weight = seen / (seen + kHalfWeightInformation);
      sum += weight * steps_[in_order_[neighbour]].array();
      total += weight;
    }
    if (neighbour - first >= kFewestNeighbours && total.minCoeff() > 0.0) {
      angles_.at(b) += (steps_[b] - (sum / total).matrix()).cast<float>();
    }
  }
}

std::vector<Beam> BeamCalibration::in_use() const {
  std::vector<Beam> beams = in_order_;
  std::copy_if(known_.begin(), known_.end(), std::back_inserter(beams),
               [&](Beam b) { return !(beams_[b].points > 0.0); });
  return beams;
}

std::vector<BeamCorrection> BeamCalibration::corrections(double offset_rad) const {
  std::vector<Beam> beams = in_use();
  sort_by_elevation(beams);
  std::vector<BeamCorrection> all;
  for (const Beam b : beams) {
    const Eigen::Vector2d add = angles_.of(b).cast<double>();
    all.push_back({b, std::atan(beams_[b].tangent) - add.x() - offset_rad, add.x(), add.y()});
  }
  return all;
}

void BeamCalibration::begin_with(const std::vector<BeamCorrection>& known, double offset_rad) {
  *this = BeamCalibration(config_);
  for (const BeamCorrection& beam : known) {
    if (beam.beam >= kBeams) continue;
    angles_.at(beam.beam) = Eigen::Vector2d(beam.add_elevation_rad, beam.add_azimuth_rad).cast<float>();
    beams_[beam.beam].tangent = std::tan(beam.elevation_rad + beam.add_elevation_rad + offset_rad);
    known_.push_back(beam.beam);
  }
}

Eigen::Vector2d BeamCalibration::rms_rad() const {
  const std::vector<Beam> beams = in_use();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  for (const Beam b : beams) {
    squares += angles_.of(b).cast<double>().cwiseAbs2();
  }
  return (squares / std::max(1.0, static_cast<double>(beams.size()))).cwiseSqrt();
}

}  // namespace rilo
