// How far apart two good poses of one sweep may lie.
#pragma once

namespace rilo {

inline constexpr double kPoseNoiseM = 0.1;
inline constexpr double kPoseNoiseRad = 0.02;

}  // namespace rilo
