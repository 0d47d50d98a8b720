// The way of the vehicle: where it is at any time.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo {

/// A closed course through the town, driven lap after lap with a speed limit, slower bends, limited acceleration and
/// stops. Both the course and the distance along it are quintic splines: positions and attitudes are C2 in time.
class DrivePath {
 public:
  /// `speed_mps`: on straight streets. `end_s`: the last time that will be asked for, s.
  DrivePath(double speed_mps, double end_s);

  /// Length of the course, m.
  double lap_m() const { return lap_m_; }
  /// When the vehicle is back where it stood at 0, s.
  double lap_s() const { return lap_s_; }

  /// Metres (along the course) since time 0; negative before. Constant beyond the range the path was made for.
  double distance_m(double t_s) const;
  /// Velocity along the course, m/s, and its derivative, m/s².
  double speed_mps(double t_s) const;
  double acceleration_mps2(double t_s) const;

  /// Centre of the driven lane `distance_m` along the course, m, world frame; periodic in the lap.
  Eigen::Vector2d position(double distance_m) const;
  /// Unit vector along the course.
  Eigen::Vector2d direction(double distance_m) const;
  /// 1/m, positive to the left.
  double curvature_per_m(double distance_m) const;

 private:
  void plan(double speed_mps, double end_s);

  double lap_m_ = 0;
  double lap_s_ = 0;
  double spacing_m_ = 0;                 ///< between control points of the course
  std::vector<Eigen::Vector2d> course_;  ///< control points, closed
  double first_s_ = 0;                   ///< time of the first of distances_
  std::vector<double> distances_;        ///< control values of distance over time
};

}  // namespace rilo
