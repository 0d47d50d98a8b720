#include "simulation/vehicle.hpp"

#include <cmath>

namespace rilo::simulation {
namespace {

constexpr double kHalfWheelbaseM = 1.35;
constexpr double kHalfTrackM = 0.78;
// Suspension: radians per m/s², about 3 and 4 degrees per g.
constexpr double kPitchPerMps2 = 0.0055;
constexpr double kRollPerMps2 = 0.007;

}  // namespace

SE3 sensor_pose(const DrivePath& path, const Terrain& terrain, double mount_height_m, double t_s) {
  const double s = path.distance_m(t_s);
  const double speed = path.speed_mps(t_s);
  const Eigen::Vector2d p = path.position(s);
  const Eigen::Vector2d ahead = path.direction(s);
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const double front = terrain.height(p + kHalfWheelbaseM * ahead);
  const double rear = terrain.height(p - kHalfWheelbaseM * ahead);
  const double left_side = terrain.height(p + kHalfTrackM * left);
  const double right_side = terrain.height(p - kHalfTrackM * left);
  // Nose down is positive pitch, left side up positive roll.
  const double pitch = std::atan2(rear - front, 2 * kHalfWheelbaseM) - kPitchPerMps2 * path.acceleration_mps2(t_s);
  const double roll =
      std::atan2(left_side - right_side, 2 * kHalfTrackM) + kRollPerMps2 * speed * speed * path.curvature_per_m(s);
  SE3 T = SE3::Identity();
  T.linear() = (Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  const double ground_m = 0.25 * (front + rear + left_side + right_side);
  T.translation() = Eigen::Vector3d(p.x(), p.y(), ground_m) + mount_height_m * T.linear().col(2);
  return T;
}

}  // namespace rilo::simulation
