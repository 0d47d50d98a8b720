// What stands between the road and the houses.
#include <cmath>
#include <numbers>

#include "simulation/car_body.hpp"
#include "simulation/counter_random.hpp"
#include "simulation/course.hpp"
#include "simulation/street_sides.hpp"

namespace rilo::simulation {
namespace {

constexpr double kInGroundM = 0.3;  // feet stand this deep in the ground

Eigen::Vector3d on_ground(const Ground& ground, const Eigen::Vector2d& p) {
  return {p.x(), p.y(), ground.height(p) - kInGroundM};
}

// Places along both sides of all streets, `step` apart, `offset` from the centre and clear of every other street.
template <typename Visit>
void for_each_place(const Ground& ground, double step, double offset, const Visit& visit) {
  std::uint64_t index = 0;
  for (const StreetLeg& leg : street_legs()) {
    const Eigen::Vector2d along = (leg.end - leg.begin).normalized();
    const double length = (leg.end - leg.begin).norm();
    for (const double side : {1.0, -1.0}) {
      for (double u = 0.5 * step; u < length; u += step) {
        const Eigen::Vector2d p = leg.begin + u * along + side * offset * left_of(along);
        ++index;
        if (ground.street_distance(p) > offset - 0.2) visit(p, along, side, index);
      }
    }
  }
}

void add_tree(const Ground& ground, const Eigen::Vector2d& p, RandomStream& random, std::vector<Solid>& solids) {
  const Eigen::Vector3d foot = on_ground(ground, p);
  const double trunk_m = random.uniform(2.4, 3.4);
  solids.push_back(make_cylinder(foot, random.uniform(0.09, 0.22), trunk_m + 1.0, 0.25));
  Solid canopy;
  canopy.kind = SolidKind::kCanopy;
  canopy.half = {random.uniform(1.3, 2.2), random.uniform(1.3, 2.2), random.uniform(1.2, 2.0)};
  canopy.centre =
      foot + Eigen::Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), trunk_m + 0.8 * canopy.half.z());
  canopy.reflectivity = 0.4;
  canopy.leaves = random.uniform(0.3, 0.55);
  canopy.key = static_cast<std::uint64_t>(random.uniform(0, 1e15));
  solids.push_back(canopy);
}

void add_sign(const Ground& ground, const Eigen::Vector2d& p, const Eigen::Vector2d& along, RandomStream& random,
              std::vector<Solid>& solids) {
  const Eigen::Vector3d foot = on_ground(ground, p);
  solids.push_back(make_cylinder(foot, 0.035, 2.8, 0.5));
  const double yaw = std::atan2(along.y(), along.x()) + random.uniform(-0.2, 0.2);
  solids.push_back(make_box(foot + Eigen::Vector3d(0, 0, 2.2), {0.04, 0.6, 0.6}, yaw, 0.9));
}

void add_small_thing(const Ground& ground, const Eigen::Vector2d& p, const Eigen::Vector2d& along, RandomStream& random,
                     std::vector<Solid>& solids) {
  const Eigen::Vector3d foot = on_ground(ground, p);
  const double yaw = std::atan2(along.y(), along.x()) + random.uniform(-0.1, 0.1);
  const double kind = random.uniform(0, 1);
  if (kind < 0.4) {
    solids.push_back(make_cylinder(foot, 0.28, 1.0 + kInGroundM, 0.3));  // bin
  } else if (kind < 0.75) {
    solids.push_back(make_box(foot, {random.uniform(0.6, 1.3), 0.4, random.uniform(1.0, 1.5)}, yaw, 0.5));  // cabinet
  } else {
    for (int i = -1; i <= 1; ++i) {  // bollards
      const Eigen::Vector2d q = p + 1.3 * i * along;
      solids.push_back(make_cylinder(on_ground(ground, q), 0.06, 0.9 + kInGroundM, 0.5));
    }
  }
}

}  // namespace

void add_street_furniture(const Ground& ground, std::uint64_t seed, double trees, std::vector<Solid>& solids) {
  for_each_place(ground, 23, kKerbM + 0.5, [&](const auto& p, const auto& along, double, std::uint64_t index) {
    RandomStream random(seed, 0x1a4b, index);
    const Eigen::Vector2d q = p + random.uniform(-2, 2) * along;
    if (random.chance(0.65)) {
      solids.push_back(make_cylinder(on_ground(ground, q), random.uniform(0.06, 0.1), random.uniform(5, 7.5), 0.45));
    } else {
      add_sign(ground, q, along, random, solids);
    }
  });
  for_each_place(ground, 9.5, kKerbM + 0.8, [&](const auto& p, const auto& along, double, std::uint64_t index) {
    RandomStream random(seed, 0x74ee, index);
    if (random.chance(0.75 * trees)) add_tree(ground, p + random.uniform(-1.5, 1.5) * along, random, solids);
  });
  for_each_place(ground, 15, kKerbM + 2.3, [&](const auto& p, const auto& along, double, std::uint64_t index) {
    RandomStream random(seed, 0xb1, index);
    if (random.chance(0.6)) add_small_thing(ground, p + random.uniform(-5, 5) * along, along, random, solids);
  });
}

void add_parked_cars(const Ground& ground, std::uint64_t seed, double parked_cars, std::vector<Solid>& solids) {
  constexpr double kPlaceM = 6.1;
  constexpr double kFromCentreM = kKerbM - 1.1;
  constexpr double kClearOfCornersM = 7;
  const auto blocks_a_corner = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& along) {
    return ground.street_distance(p + kClearOfCornersM * along) < kFromCentreM - 0.4 ||
           ground.street_distance(p - kClearOfCornersM * along) < kFromCentreM - 0.4;
  };
  for_each_place(
      ground, kPlaceM, kFromCentreM, [&](const auto& p, const auto& along, double side, std::uint64_t index) {
        RandomStream random(seed, 0xca4, index);
        if (!random.chance(parked_cars) || blocks_a_corner(p, along)) return;
        const CarBody body = draw_car(random);
        const Eigen::Vector2d q = p + random.uniform(-0.25, 0.25) * along + random.uniform(-0.1, 0.1) * left_of(along);
        const bool against = random.chance(side > 0 ? 0.8 : 0.1);  // most stand as the traffic on their side drives
        const double yaw =
            std::atan2(along.y(), along.x()) + random.uniform(-0.03, 0.03) + (against ? std::numbers::pi : 0);
        place_car(body, {q.x(), q.y(), ground.height(q) - 0.02}, yaw, solids);
      });
}

}  // namespace rilo::simulation
