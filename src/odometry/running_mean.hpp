// Means over the last few sweeps.
#pragma once

namespace rilo {

/// Share of a new value in a running mean over about five sweeps.
inline constexpr double kRunningShare = 0.2;

}  // namespace rilo
