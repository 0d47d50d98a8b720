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
/// number of times, and the small remainder to a point's own time is of second order. The error is below a tenth of a
/// millimetre at 100 m, 360 °/s and 30 m/s over a sweep of 0.1 s, a fifth of one at 30 m, 50 rad/s² and 40 m/s².
class SweepMotion {
 public:
  /// `span`: of the offsets that will be asked for.
  SweepMotion(const BodyMotion& motion, const TimeSpan& span);
  /// Over the span of the cloud's offsets.
  static SweepMotion during(const TimedCloud& cloud, const BodyMotion& motion) { return {motion, span_of(cloud)}; }

  /// Point `p` measured at `offset_s`, expressed in the sensor frame at the reference time (offset 0).
  Eigen::Vector3f compensate(const Eigen::Vector3f& p, float offset_s) const {
    const float position = (offset_s - begin_s_) * inverse_step_;
    const int bin = static_cast<int>(position + 0.5F);
    const Knot& knot = knots_[static_cast<std::size_t>(bin < 0 ? 0 : (bin > last_ ? last_ : bin))];
    const float rest = offset_s - knot.offset_s;
    const Eigen::Vector3f rate = knot.omega.cross(p) + knot.velocity;
    const Eigen::Vector3f q = p + rest * (rate + 0.5F * rest * knot.omega.cross(rate));
    return knot.R * q + knot.t;
  }

  /// Point `i` of `cloud` in the same way; as it is when it has no times.
  Eigen::Vector3f compensated(const TimedCloud& cloud, std::size_t i) const {
    return cloud.timed() ? compensate(cloud.points[i], cloud.offsets_s[i]) : cloud.points[i];
  }

 private:
  struct Knot {
    Eigen::Matrix3f R;
    Eigen::Vector3f t;
    Eigen::Vector3f omega;  // at the knot
    Eigen::Vector3f velocity;
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
