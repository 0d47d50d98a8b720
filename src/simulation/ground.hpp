// The surface that is driven and walked on: cambered roads, kerbs, raised pavements on rolling terrain.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "simulation/ray.hpp"
#include "simulation/terrain.hpp"

namespace rilo::simulation {

constexpr double kKerbM = 5.6;          ///< from a street's centre: two lanes and parking places
constexpr double kRaisedM = 0.04;       ///< pavements above the terrain
constexpr double kGutterM = 0.10;       ///< gutters below the terrain; the crown of the road lies on it
constexpr double kFarFromStreetM = 12;  ///< distances to streets are known up to here

/// Ground within a rectangle; nothing outside. Terrain and distance to the nearest street are kept on a raster.
class Ground {
 public:
  /// `centre_lines`: of the streets, pieces (begin, end) of a few metres.
  Ground(const Terrain& terrain, const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& centre_lines,
         const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  /// Distance to the nearest street's centre (m), kFarFromStreetM when it is farther, or `p` is outside.
  double street_distance(const Eigen::Vector2d& p) const;
  /// Height of the surface (m); the terrain's outside.
  double height(const Eigen::Vector2d& p) const;
  bool contains(const Eigen::Vector2d& p) const;
  const Eigen::Vector2d& low() const { return low_; }
  const Eigen::Vector2d& high() const { return high_; }

  /// Offers what the ray meets nearer than `hit`.
  void cast(const Ray& ray, Hit& hit) const;

 private:
  struct Sample {
    float terrain;
    float street;
  };
  struct Place {
    double terrain, street;
  };

  void measure_street(const Eigen::Vector2d& begin, const Eigen::Vector2d& end);
  void measure_slope();
  Place place(const Eigen::Vector2d& p) const;
  static double road_height(const Place& place);
  void cast_on_road(const Ray& ray, double start, double limit, Hit& hit) const;

  Eigen::Vector2d low_, high_;
  std::size_t columns_ = 0, rows_ = 0;
  std::vector<Sample> raster_;
  double steepest_ = 0;  // slope of the terrain
};

}  // namespace rilo::simulation
