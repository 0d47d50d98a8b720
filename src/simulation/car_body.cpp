#include "simulation/car_body.hpp"

#include <cmath>

namespace rilo::simulation {
namespace {

void add_wheels(std::vector<Solid>& parts, double length, double width) {
  for (const double x : {0.31, -0.31}) {
    for (const double y : {0.5, -0.5}) {
      parts.push_back(make_box({x * length, y * (width - 0.24), 0}, {0.62, 0.2, 0.62}, 0, 0.12));
    }
  }
}

Solid window_band(const Eigen::Vector3d& base, const Eigen::Vector3d& size) {
  Solid band = make_box(base, size, 0, 0.15);
  band.glass = true;
  return band;
}

}  // namespace

CarBody draw_car(RandomStream& random) {
  CarBody car;
  const double paint = random.uniform(0.15, 0.8);
  const bool van = random.chance(0.18);
  const bool estate = random.chance(0.4);
  const double length = van ? random.uniform(4.7, 5.6) : random.uniform(3.7, 4.7);
  const double width = van ? random.uniform(1.9, 2.05) : random.uniform(1.65, 1.85);
  const double height = van ? random.uniform(1.95, 2.5) : random.uniform(1.4, 1.6);
  const double belt = van ? 1.1 : random.uniform(0.85, 0.98);
  car.radius_m = 0.5 * std::hypot(length, width);
  add_wheels(car.parts, length, width);
  car.parts.push_back(make_box({0, 0, 0.22}, {length, width, belt - 0.22}, 0, paint));
  // The cabin: as long as the car behind a bonnet, for a saloon shorter than that behind too.
  const double front = 0.5 * length - (van ? 0.55 : 1.25);
  const double rear = -0.5 * length + (van || estate ? 0.1 : 0.85);
  const double middle = 0.5 * (front + rear);
  const double roof = height - 0.12;
  car.parts.push_back(window_band({middle, 0, belt}, {front - rear, width - 0.16, roof - belt}));
  car.parts.push_back(make_box({middle - 0.1, 0, roof}, {front - rear - 0.5, width - 0.3, height - roof}, 0, paint));
  if (van) car.parts.push_back(make_box({rear + 1.6, 0, belt}, {3.2, width - 0.06, roof - belt}, 0, paint));
  return car;
}

void place_car(const CarBody& body, const Eigen::Vector3d& position, double yaw_rad, std::vector<Solid>& solids) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  for (Solid part : body.parts) {
    const Eigen::Vector3d p = part.centre;
    part.centre = position + Eigen::Vector3d(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    part.cos_yaw = c;
    part.sin_yaw = s;
    solids.push_back(part);
  }
}

}  // namespace rilo::simulation
