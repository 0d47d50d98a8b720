#include "rilo/odometry/sweep_result.hpp"

#include <array>
#include <cstddef>

namespace rilo {

namespace {

// In the order of the values.
template <typename Enum, std::size_t N>
std::string_view word_of(Enum value, const std::array<std::string_view, N>& names) {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? names[i] : "unknown";
}

}  // namespace

std::string_view to_string(OdometryStatus status) {
  constexpr std::array<std::string_view, kStatusCount> kNames = {"ok",   "initialising", "degenerate",
                                                                 "lost", "recovered",    "empty"};
  return word_of(status, kNames);
}

std::string_view to_string(LossCause cause) {
  constexpr std::array<std::string_view, kLossCauseCount> kNames = {"none",
                                                                    "unsolved",
                                                                    "covered",
                                                                    "out_of_time",
                                                                    "ambiguous",
                                                                    "fits_worse",
                                                                    "found_by_chance",
                                                                    "fits_beside",
                                                                    "loose_after_gap",
                                                                    "not_converged",
                                                                    "weak_second_sweep",
                                                                    "low_score",
                                                                    "impossible_motion"};
  return word_of(cause, kNames);
}

bool belongs_in_map(OdometryStatus status, bool timed) {
  switch (status) {
    case OdometryStatus::kLost:
    case OdometryStatus::kEmpty:
      return false;
    case OdometryStatus::kInitialising:
      return !timed;
    default:
      return true;
  }
}

std::string_view to_string(InitialPoseSource source) {
  constexpr std::array<std::string_view, 3> kNames = {"identity", "prediction", "coarse"};
  return word_of(source, kNames);
}

std::string_view to_string(PoseInstant instant) {
  constexpr std::array<std::string_view, 3> kNames = {"start", "mid", "end"};
  return word_of(instant, kNames);
}

std::string_view to_string(InitialPoseReason reason) {
  constexpr std::array<std::string_view, 8> kNames = {"first_sweep",     "coarse_disabled", "coarse_not_needed",
                                                      "within_tau",      "beyond_tau",      "better_map_score",
                                                      "worse_map_score", "no_time"};
  return word_of(reason, kNames);
}

}  // namespace rilo
