// Means over the last few sweeps.
#pragma once

namespace rilo {

/// Share of a new value in a running mean over about five sweeps.
inline constexpr double kRunningShare = 0.2;

/// Moves `usual`, 0 while it is unknown, towards `value`.
inline void follow(double& usual, double value, double share = kRunningShare) {
  usual = usual > 0.0 ? usual + share * (value - usual) : value;
}

}  // namespace rilo
