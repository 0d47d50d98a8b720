#include "simulation/traffic.hpp"

#include <cmath>

#include "simulation/course.hpp"

namespace rilo::simulation {
namespace {

constexpr double kHeadwayS = 9;  // far enough that nobody drives up where the one ahead stands still
constexpr double kOncomingMps = 6.5;
constexpr std::size_t kPlacesOncoming = 8;

}  // namespace

// Of three cars one drives the vehicle's way, ahead and behind in turns; the others come towards it.
Traffic::Traffic(std::size_t cars, std::uint64_t seed) {
  std::size_t oncoming = 0;
  for (std::size_t i = 0; i < cars; ++i) {
    RandomStream random(seed, 0x7af1c, i);
    Car car{draw_car(random), i % 3 != 0, 0};
    if (car.oncoming) {
      // Spread round the lap in an order that a few cars cover too (3 and 8 have no common divisor).
      car.lead = static_cast<double>((3 * oncoming++ + 1) % kPlacesOncoming) / static_cast<double>(kPlacesOncoming);
    } else {
      const std::size_t place = i / 3;
      const std::size_t headways = place / 2 + 1;
      car.lead = (place % 2 == 0 ? kHeadwayS : -kHeadwayS) * static_cast<double>(headways);
    }
    cars_.push_back(car);
  }
}

Traffic::Instant Traffic::at(double t_s, const DrivePath& path, const Terrain& terrain, const Eigen::Vector2d& near,
                             double reach_m) const {
  constexpr double kOnCrownM = 0.03;  // lanes lie a little below the crown of the road, which lies on the terrain
  Instant now;
  for (const Car& car : cars_) {
    const double s = car.oncoming ? car.lead * path.lap_m() - kOncomingMps * t_s : path.distance_m(t_s + car.lead);
    Eigen::Vector2d heading = path.direction(s);
    Eigen::Vector2d p = path.position(s);
    if (car.oncoming) {
      p += 2 * kLaneOffsetM * Eigen::Vector2d(-heading.y(), heading.x());
      heading = -heading;
    }
    if ((p - near).norm() > reach_m + car.body.radius_m) continue;
    const std::size_t begin = now.parts_.size();
    place_car(car.body, {p.x(), p.y(), terrain.height(p) - kOnCrownM}, std::atan2(heading.y(), heading.x()),
              now.parts_);
    now.cars_.push_back({p, car.body.radius_m, begin, now.parts_.size()});
  }
  return now;
}

void Traffic::Instant::cast(const Ray& ray, Hit& hit) const {
  const Eigen::Vector2d d = ray.direction.head<2>();
  for (const Placed& car : cars_) {
    const Eigen::Vector2d to = car.centre - ray.origin.head<2>();
    const double side = d.x() * to.y() - d.y() * to.x();
    if (side * side > car.radius_m * car.radius_m * d.squaredNorm()) continue;
    for (std::size_t i = car.begin; i < car.end; ++i) simulation::cast(parts_[i], ray, hit);
  }
}

}  // namespace rilo::simulation
