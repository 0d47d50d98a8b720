// The plan of the town: the course that is driven, and the streets.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace rilo::simulation {

constexpr double kLaneOffsetM = 1.75;  ///< of the driven lane to the right of the street's centre

/// The direction a quarter turn to the left.
inline Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

/// A corner of the course before it is rounded.
struct CourseCorner {
  Eigen::Vector2d point;
  double radius_m;
};

/// Corners of the closed course, in driving order (left turns, one right turn, two slight bends).
const std::vector<CourseCorner>& course_corners();

/// The course with rounded corners as points `spacing_m` apart (about: a whole number of them goes round).
std::vector<Eigen::Vector2d> rounded_course(double spacing_m);

/// A straight piece of street, along which houses and cars are placed.
struct StreetLeg {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
  bool side_street;
};

/// Centre lines of all streets: the legs of the course, then the side streets that leave it at the corners.
std::vector<StreetLeg> street_legs();

}  // namespace rilo::simulation
