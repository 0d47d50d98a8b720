// Errors of the angles of single beams, observed through the map.
//
// A surface of the map is made by many beams; the mean residual of one beam against it is the error of that beam. Each
// beam follows its residuals by small steps (an integral controller with the step of Gauss and Newton). Only the
// difference to the neighbouring beams is followed: what changes slowly with the elevation angle cannot be separated
// from grass, grazing incidence or from the poses, and following it makes the drift worse.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "cloud/beam_angles.hpp"
#include "cloud/beam_sample.hpp"
#include "registration/adaptive_icp.hpp"
#include "rilo/calibration/sensor_angles.hpp"
#include "rilo/stage_config.hpp"

namespace rilo {

/// Learns the angles of the beams from registered sweeps.
class BeamCalibration {
 public:
  explicit BeamCalibration(const BeamCalibrationConfig& config)
      : config_(config), beams_(kBeams, Information{}), steps_(kBeams, Eigen::Vector2d::Zero()) {}

  /// Takes one step. `sample`: points with `angles()` applied; `icp`: how the sweep was registered, with `sigma_th_m`
  /// and `config`, on `map`.
  void learn(const BeamSample& sample, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
             const AdaptiveIcpConfig& config);

  /// What to add to the angles of each beam. Zero for sensors whose beams have too few neighbours.
  const BeamAngles& angles() const { return angles_; }

  /// Root mean square of the corrections over all beams in use, elevation and azimuth (rad).
  Eigen::Vector2d rms_rad() const;

  /// The corrections of the beams in use, whose points had `offset_rad` added to their elevation angles.
  std::vector<BeamCorrection> corrections(double offset_rad) const;

  /// Forgets the sweeps and begins with `known`, see corrections().
  void begin_with(const std::vector<BeamCorrection>& known, double offset_rad);

 private:
  /// Of one beam: normal equations of elevation and azimuth, of the last sweep and averaged.
  struct Information {
    Eigen::Matrix2d sweep = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    double tangent = 0;  // of the elevation angle, mean over the points
    double points = 0;
  };
  struct Observation {
    Eigen::Vector2d jacobian = Eigen::Vector2d::Zero();
    double residual_m = 0;
    double weight = 0;
  };
  void observe(const BeamSample& sample, const LocalMap& map, const IcpResult& icp, double sigma_th_m,
               const AdaptiveIcpConfig& config);
  void sum_up(const BeamSample& sample);
  void find_steps();
  void apply_differences();
  void sort_by_elevation(std::vector<Beam>& beams) const;
  /// The beams that sweeps have shown, and those that were begun with and none has.
  std::vector<Beam> in_use() const;

  BeamCalibrationConfig config_;
  BeamAngles angles_;
  std::vector<Information> beams_;
  std::vector<Eigen::Vector2d> steps_;
  std::vector<Beam> in_order_;  // beams that the sweeps have shown, by elevation
  std::vector<Beam> known_;     // beams that were begun with: while no sweep shows them, they keep their angles
  std::vector<Observation> observations_;
  double sweeps_ = 0;
};

}  // namespace rilo
