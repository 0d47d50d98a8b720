// The other cars that drive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/car_body.hpp"
#include "simulation/drive_path.hpp"
#include "simulation/ray.hpp"
#include "simulation/terrain.hpp"

namespace rilo::simulation {

/// Cars that drive the same course, some as the vehicle does, seconds ahead or behind, the others the other way round.
class Traffic {
 public:
  Traffic(std::size_t cars, std::uint64_t seed);

  /// The cars at one instant, near enough to `near` to be seen within `reach_m`.
  class Instant {
   public:
    void cast(const Ray& ray, Hit& hit) const;

   private:
    friend class Traffic;
    struct Placed {
      Eigen::Vector2d centre;
      double radius_m;
      std::size_t begin, end;  // of parts_
    };
    std::vector<Placed> cars_;
    std::vector<Solid> parts_;
  };
  Instant at(double t_s, const DrivePath& path, const Terrain& terrain, const Eigen::Vector2d& near,
             double reach_m) const;

 private:
  struct Car {
    CarBody body;
    bool oncoming = false;
    double lead = 0;  // seconds ahead of the vehicle; of oncoming cars the share of the lap where they are at 0
  };
  std::vector<Car> cars_;
};

}  // namespace rilo::simulation
