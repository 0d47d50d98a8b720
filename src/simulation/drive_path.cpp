#include "simulation/drive_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "simulation/course.hpp"
#include "simulation/quintic_spline.hpp"

namespace rilo {
namespace {

constexpr double kCourseSpacingM = 2.5;
constexpr double kTimeStepS = 0.25;   // between control values of the distance
constexpr double kLateralMps2 = 2.5;  // what bends are taken with
constexpr double kForwardMps2 = 2.0;
constexpr double kBrakingMps2 = 2.2;
constexpr double kStopS = 2.4;
constexpr double kStandingAtStartS = 1.2;  // longer than a spline's reach: time 0 stands still exactly
constexpr double kSecondStop = 0.56;       // share of the lap
constexpr double kAfterEndS = 30;          // other cars drive the same plan some seconds ahead

// One lap in steps of `step_m`: the speed at each node (0 at stops), then when each node is left.
struct LapPlan {
  double step_m = 0;
  std::vector<double> speed;  // nodes 0 … n; node n is node 0 of the next lap
  std::vector<double> leave;  // s since leaving node 0; of node n: since leaving, the stop there included
};

void limit_acceleration(std::vector<double>& speed, double step_m) {
  for (std::size_t i = 1; i < speed.size(); ++i) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i - 1] * speed[i - 1] + 2 * kForwardMps2 * step_m));
  }
  for (std::size_t i = speed.size() - 1; i-- > 0;) {
    speed[i] = std::min(speed[i], std::sqrt(speed[i + 1] * speed[i + 1] + 2 * kBrakingMps2 * step_m));
  }
}

LapPlan plan_lap(const DrivePath& path, double speed_mps) {
  constexpr std::size_t kNodes = 1200;
  LapPlan plan;
  plan.step_m = path.lap_m() / static_cast<double>(kNodes);
  for (std::size_t i = 0; i <= kNodes; ++i) {
    const double curvature = std::abs(path.curvature_per_m(static_cast<double>(i) * plan.step_m));
    plan.speed.push_back(std::min(speed_mps, std::sqrt(kLateralMps2 / std::max(curvature, 1e-6))));
  }
  const auto stop = static_cast<std::size_t>(std::lround(kSecondStop * static_cast<double>(kNodes)));
  plan.speed.front() = plan.speed.back() = plan.speed[stop] = 0;
  limit_acceleration(plan.speed, plan.step_m);
  plan.leave.push_back(0);
  for (std::size_t i = 1; i <= kNodes; ++i) {
    const double moving_s = 2 * plan.step_m / (plan.speed[i] + plan.speed[i - 1]);
    plan.leave.push_back(plan.leave.back() + moving_s + (i == stop || i == kNodes ? kStopS : 0));
  }
  return plan;
}

// Metres into the lap, `t` seconds after its node 0 was left.
double distance_in_lap(const LapPlan& plan, double t) {
  const auto next = std::upper_bound(plan.leave.begin(), plan.leave.end(), t);
  const auto i = static_cast<std::size_t>(next - plan.leave.begin()) - 1;
  if (i + 1 >= plan.leave.size()) return plan.step_m * static_cast<double>(i);
  const double v0 = plan.speed[i];
  const double v1 = plan.speed[i + 1];
  const double acceleration = (v1 * v1 - v0 * v0) / (2 * plan.step_m);
  const double moving_s = std::min(t - plan.leave[i], 2 * plan.step_m / (v0 + v1));
  return plan.step_m * static_cast<double>(i) + v0 * moving_s + 0.5 * acceleration * moving_s * moving_s;
}

// Course and its derivatives per control spacing; periodic.
Eigen::Vector2d course_spline(const std::vector<Eigen::Vector2d>& control, double u, std::size_t derivative) {
  const auto n = static_cast<long>(control.size());
  const double whole = std::floor(u);
  const auto first = static_cast<long>(whole) - 2;
  std::array<Eigen::Vector2d, 6> near;
  for (std::size_t i = 0; i < near.size(); ++i) {
    near[i] = control[static_cast<std::size_t>((((first + static_cast<long>(i)) % n) + n) % n)];
  }
  return simulation::quintic_spline(near, derivative, u - whole);
}

// Distance over time and its derivatives per step; constant beyond the ends.
double distance_spline(const std::vector<double>& control, double u, std::size_t derivative) {
  const auto last = static_cast<double>(control.size()) - 4;
  const double inside = std::clamp(u, 2.0, last);
  if (inside != u && derivative > 0) return 0;
  const double whole = std::floor(inside);
  std::array<double, 6> near{};
  for (std::size_t i = 0; i < near.size(); ++i) near[i] = control[static_cast<std::size_t>(whole) - 2 + i];
  return simulation::quintic_spline(near, derivative, inside - whole);
}

}  // namespace

DrivePath::DrivePath(double speed_mps, double end_s) : course_(simulation::rounded_course(kCourseSpacingM)) {
  double length = 0;
  for (std::size_t i = 0; i < course_.size(); ++i) length += (course_[(i + 1) % course_.size()] - course_[i]).norm();
  spacing_m_ = length / static_cast<double>(course_.size());
  lap_m_ = length;
  plan(speed_mps, end_s);
}

void DrivePath::plan(double speed_mps, double end_s) {
  const LapPlan lap = plan_lap(*this, speed_mps);
  lap_s_ = lap.leave.back();
  // Node 0 of lap 0 is left at kStandingAtStartS; one lap before that is planned too.
  first_s_ = kStandingAtStartS - lap_s_;
  const auto count = static_cast<std::size_t>(std::ceil((end_s + kAfterEndS - first_s_) / kTimeStepS)) + 6;
  distances_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) * kTimeStepS;
    const double laps = std::floor(t / lap_s_);
    distances_.push_back((laps - 1) * lap_m_ + distance_in_lap(lap, t - laps * lap_s_));
  }
}

double DrivePath::distance_m(double t_s) const { return distance_spline(distances_, (t_s - first_s_) / kTimeStepS, 0); }

double DrivePath::speed_mps(double t_s) const {
  return distance_spline(distances_, (t_s - first_s_) / kTimeStepS, 1) / kTimeStepS;
}

double DrivePath::acceleration_mps2(double t_s) const {
  return distance_spline(distances_, (t_s - first_s_) / kTimeStepS, 2) / (kTimeStepS * kTimeStepS);
}

Eigen::Vector2d DrivePath::position(double distance_m) const {
  return course_spline(course_, distance_m / spacing_m_, 0);
}

Eigen::Vector2d DrivePath::direction(double distance_m) const {
  return course_spline(course_, distance_m / spacing_m_, 1).normalized();
}

double DrivePath::curvature_per_m(double distance_m) const {
  const Eigen::Vector2d d1 = course_spline(course_, distance_m / spacing_m_, 1);
  const Eigen::Vector2d d2 = course_spline(course_, distance_m / spacing_m_, 2);
  return (d1.x() * d2.y() - d1.y() * d2.x()) / std::pow(d1.norm(), 3);
}

}  // namespace rilo
