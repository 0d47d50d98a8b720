// Angles for people: configuration, sensor data sheets and reports are in degrees, everything else in radians.
#pragma once

#include <numbers>

namespace rilo {

inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;
inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

}  // namespace rilo
