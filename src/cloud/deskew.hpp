// Motion compensation from per-point times.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "cloud/time_span.hpp"
#include "cloud/timed_cloud.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Velocity of the sensor about its own axes [rad/s; m/s], and its change.
struct BodyMotion {
  Vector6d twist = Vector6d::Zero();         ///< at the reference time
  Vector6d acceleration = Vector6d::Zero();  ///< [rad/s²; m/s²], constant during the sweep
};

/// From the first to the last offset of the points of a sweep; zero without times.
TimeSpan span_of(const TimedCloud& cloud);

/// Motion of the sensor during a sweep at constant acceleration, tabulated: the exponential is evaluated at a fixed
/// number of times, and between them the pose changes linearly. The error is below a third of a millimetre at 100 m,
/// 360 °/s and 30 m/s over a sweep of 0.1 s, a quarter of one at 30 m, 50 rad/s² and 40 m/s².
class SweepMotion {
 public:
  /// `span`: of the offsets that will be asked for. `R_out_sensor`: axes of the result, about the sensor.
  SweepMotion(const BodyMotion& motion, const TimeSpan& span,
              const Eigen::Matrix3d& R_out_sensor = Eigen::Matrix3d::Identity());
  /// Over the span of the cloud's offsets.
  static SweepMotion during(const TimedCloud& cloud, const BodyMotion& motion) { return {motion, span_of(cloud)}; }

  /// Point `p` measured at `offset_s`, as seen from the sensor at the reference time (offset 0).
  Eigen::Vector3f compensate(const Eigen::Vector3f& p, float offset_s) const {
    const float position = (offset_s - begin_s_) * inverse_step_;
    const int bin = static_cast<int>(position + 0.5F);
    const Knot& knot = knots_[static_cast<std::size_t>(bin < 0 ? 0 : (bin > last_ ? last_ : bin))];
    const Eigen::Matrix4f T = knot.T + (offset_s - knot.offset_s) * knot.rate;
    return (T * Eigen::Vector4f(p.x(), p.y(), p.z(), 1.0F)).head<3>();
  }

  /// Point `i` of `cloud` in the same way; one without times is of the reference time.
  Eigen::Vector3f compensated(const TimedCloud& cloud, std::size_t i) const {
    return compensate(cloud.points[i], cloud.timed() ? cloud.offsets_s[i] : 0.0F);
  }

 private:
  struct Knot {
    Eigen::Matrix4f T;     // of the sensor at that time in the result's frame
    Eigen::Matrix4f rate;  // its derivative
    float offset_s;
  };
  float begin_s_;
  float inverse_step_;
  int last_;
  std::vector<Knot> knots_;
};

/// Motion-compensates `cloud` for the motion of its sensor. Untimed clouds are copied. `out` is resized to the cloud's
/// size.
void deskew(const TimedCloud& cloud, const BodyMotion& motion, std::vector<Eigen::Vector3f>& out);

/// The same for at most `count` of its points, evenly spread over their order.
std::vector<Eigen::Vector3f> deskew_picked(const TimedCloud& cloud, const BodyMotion& motion, std::size_t count);

}  // namespace rilo
