// The bodies that the town is made of.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "simulation/ray.hpp"

namespace rilo::simulation {

enum class SolidKind : std::uint8_t { kBox, kHouse, kCylinder, kCanopy };

/// Windows and doors of a house: a grid of openings on each of its four faces.
struct Relief {
  double foot_m = 0;  ///< how deep the box stands in the ground: heights count from there
  double storey_m = 3;
  double bay_m = 2.8;         ///< width of a window's share of the front, fitted to a whole number
  double window_share = 0.5;  ///< of a bay's width
  double sill_m = 0.9;        ///< above the storey's floor
  double window_m = 1.4;      ///< height
  double window_depth_m = 0.18;
  double door_depth_m = 0.45;
  std::uint64_t key = 0;  ///< which bays have doors
};

/// One body, upright, turned about its vertical axis (canopies are not turned).
struct Solid {
  SolidKind kind = SolidKind::kBox;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d half = Eigen::Vector3d::Ones();  ///< half sizes; of a cylinder radius, radius, half height
  double cos_yaw = 1, sin_yaw = 0;
  double reflectivity = 0.4;
  bool glass = false;
  Relief relief;          ///< of houses
  double leaves = 0;      ///< share of a canopy's cells that hold a leaf
  std::uint64_t key = 0;  ///< of a canopy's leaves

  Eigen::Vector2d extent() const;  ///< half sizes of the bounding box in the plane
};

/// A box of `size` whose base centre is `base`.
Solid make_box(const Eigen::Vector3d& base, const Eigen::Vector3d& size, double yaw_rad, double reflectivity);
Solid make_cylinder(const Eigen::Vector3d& base, double radius, double height, double reflectivity);

/// Offers where the ray enters the body, when it is nearer than `hit`.
void cast(const Solid& solid, const Ray& ray, Hit& hit);

}  // namespace rilo::simulation
