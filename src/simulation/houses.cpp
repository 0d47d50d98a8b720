// Rows of houses.
#include <algorithm>
#include <cmath>

#include "simulation/counter_random.hpp"
#include "simulation/course.hpp"
#include "simulation/street_sides.hpp"

namespace rilo::simulation {
namespace {

constexpr double kFrontM = 8.6;  // house fronts from a street's centre, at the least
constexpr double kFootM = 1.2;   // walls reach this far into the ground, which slopes

// A place for a house: its front runs from `corner` along `along`, its body lies to `away` from the street.
struct Plot {
  Eigen::Vector2d corner, along, away;
  double width = 0, depth = 0;

  Eigen::Vector2d at(double u, double v) const { return corner + u * along + v * away; }
};

// No street passes through the plot.
bool is_free(const Ground& ground, const Plot& plot) {
  constexpr double kStepM = 1.0;
  for (double u = 0; u <= plot.width; u += kStepM) {
    for (double v = 0; v <= plot.depth; v += kStepM) {
      const Eigen::Vector2d p = plot.at(u, v);
      if (!ground.contains(p) || ground.street_distance(p) < kFrontM - 0.3) return false;
    }
  }
  return true;
}

// Bodies in front of the wall: `out` metres deep, from u0 to u1 and from height z0 to z1 above the plot's ground.
class Front {
 public:
  Front(const Plot& plot, double ground_m, double reflectivity, std::vector<Solid>& solids)
      : plot_(plot), ground_m_(ground_m), reflectivity_(reflectivity), solids_(solids) {}

  void add(double u0, double u1, double z0, double z1, double out) {
    const Eigen::Vector2d p = plot_.at(0.5 * (u0 + u1), -0.5 * out);
    const double yaw = std::atan2(plot_.along.y(), plot_.along.x());
    solids_.push_back(make_box({p.x(), p.y(), ground_m_ + z0}, {u1 - u0, out, z1 - z0}, yaw, reflectivity_));
  }

 private:
  Plot plot_;
  double ground_m_, reflectivity_;
  std::vector<Solid>& solids_;
};

Relief draw_relief(RandomStream& random) {
  Relief relief;
  relief.foot_m = kFootM;
  relief.storey_m = random.uniform(2.8, 3.5);
  relief.bay_m = random.uniform(2.2, 3.4);
  relief.window_share = random.uniform(0.35, 0.6);
  relief.sill_m = random.uniform(0.7, 1.1);
  relief.window_m = random.uniform(1.2, 1.7);
  relief.window_depth_m = random.uniform(0.10, 0.28);
  relief.door_depth_m = random.uniform(0.3, 0.7);
  relief.key = static_cast<std::uint64_t>(random.uniform(0, 1e15));
  return relief;
}

void add_ornaments(Front front, const Plot& plot, const Relief& relief, double height, RandomStream& random) {
  const double pilaster_m = random.uniform(0.3, 0.6);
  const double out = random.uniform(0.08, 0.2);
  front.add(0, pilaster_m, -kFootM, height, out);
  if (random.chance(0.5)) front.add(plot.width - pilaster_m, plot.width, -kFootM, height, out);
  if (random.chance(0.6)) front.add(0, plot.width, relief.storey_m - 0.25, relief.storey_m + 0.05, 0.5 * out + 0.06);
  if (random.chance(0.35)) {  // a step or plinth
    front.add(0.2 * plot.width, 0.6 * plot.width, -kFootM, random.uniform(0.3, 0.7), random.uniform(0.15, 0.4));
  }
  const double bay_m = plot.width / std::max(1.0, std::floor(plot.width / relief.bay_m));
  for (double u = 0; u + bay_m < plot.width + 0.1; u += bay_m) {
    if (!random.chance(0.12)) continue;
    const double floor_m = relief.storey_m * (random.chance(0.5) ? 1.0 : 2.0);
    if (floor_m + 1.5 > height) continue;
    front.add(u + 0.2, u + bay_m - 0.2, floor_m - 0.15, floor_m + 0.9, random.uniform(0.7, 1.1));  // balcony
  }
}

void build(const Ground& ground, const Plot& plot, RandomStream& random, std::vector<Solid>& solids) {
  const Relief relief = draw_relief(random);
  const double height = relief.storey_m * std::floor(random.uniform(2, 5)) + random.uniform(0.4, 1.2);
  const Eigen::Vector2d centre = plot.at(0.5 * plot.width, 0.5 * plot.depth);
  const double ground_m = ground.height(plot.at(0.5 * plot.width, -0.5));
  const double yaw = std::atan2(plot.along.y(), plot.along.x());
  const double reflectivity = random.uniform(0.25, 0.6);
  Solid house = make_box({centre.x(), centre.y(), ground_m - kFootM}, {plot.width, plot.depth, height + kFootM}, yaw,
                         reflectivity);
  house.kind = SolidKind::kHouse;
  house.relief = relief;
  solids.push_back(house);
  add_ornaments(Front(plot, ground_m, reflectivity, solids), plot, relief, height, random);
}

// Fills one side of a street from `begin` on, house by house; narrower ones where a wide one does not fit.
void build_row(const Ground& ground, const Eigen::Vector2d& begin, const Eigen::Vector2d& along,
               const Eigen::Vector2d& away, double length, RandomStream& random, std::vector<Solid>& solids) {
  for (double u = 0; u < length;) {
    const double setback = random.chance(0.3) ? random.uniform(0.3, 1.6) : random.uniform(0.0, 0.15);
    Plot plot{begin + u * along + setback * away, along, away, random.uniform(7, 14), random.uniform(7.0, 9.0)};
    while (plot.width >= 5 && !is_free(ground, plot)) plot.width -= 2;
    if (plot.width < 5) {
      u += 1;
      continue;
    }
    build(ground, plot, random, solids);
    u += plot.width + (random.chance(0.15) ? random.uniform(1.0, 3.5) : 0.0);  // now and then a passage
  }
}

}  // namespace

void add_houses(const Ground& ground, std::uint64_t seed, std::vector<Solid>& solids) {
  constexpr double kBeyondCornersM = 14;
  std::uint64_t row = 0;
  for (const StreetLeg& leg : street_legs()) {
    const Eigen::Vector2d along = (leg.end - leg.begin).normalized();
    const double length = (leg.end - leg.begin).norm() + 2 * kBeyondCornersM;
    for (const double side : {1.0, -1.0}) {
      RandomStream random(seed, 0x4005e, row++);
      const Eigen::Vector2d away = side * left_of(along);
      build_row(ground, leg.begin - kBeyondCornersM * along + kFrontM * away, along, away, length, random, solids);
    }
    if (!leg.side_street) continue;
    RandomStream random(seed, 0x4005e, row++);
    const Eigen::Vector2d across = left_of(along);
    build_row(ground, leg.end + kFrontM * along - 12 * across, across, along, 24, random, solids);
  }
}

}  // namespace rilo::simulation
