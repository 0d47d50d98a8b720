#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

std::string_view to_string(OdometryStatus status) {
  switch (status) {
    case OdometryStatus::kOk:
      return "ok";
    case OdometryStatus::kInitialising:
      return "initialising";
    case OdometryStatus::kDegenerate:
      return "degenerate";
    case OdometryStatus::kLost:
      return "lost";
    case OdometryStatus::kRecovered:
      return "recovered";
    case OdometryStatus::kEmpty:
      return "empty";
  }
  return "unknown";
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
  switch (source) {
    case InitialPoseSource::kIdentity:
      return "identity";
    case InitialPoseSource::kPrediction:
      return "prediction";
    case InitialPoseSource::kCoarse:
      return "coarse";
  }
  return "unknown";
}

std::string_view to_string(PoseInstant instant) {
  switch (instant) {
    case PoseInstant::kStart:
      return "start";
    case PoseInstant::kMid:
      return "mid";
    case PoseInstant::kEnd:
      return "end";
  }
  return "unknown";
}

std::string_view to_string(InitialPoseReason reason) {
  switch (reason) {
    case InitialPoseReason::kFirstSweep:
      return "first_sweep";
    case InitialPoseReason::kCoarseDisabled:
      return "coarse_disabled";
    case InitialPoseReason::kCoarseNotNeeded:
      return "coarse_not_needed";
    case InitialPoseReason::kWithinTau:
      return "within_tau";
    case InitialPoseReason::kBeyondTau:
      return "beyond_tau";
    case InitialPoseReason::kBetterMapScore:
      return "better_map_score";
    case InitialPoseReason::kWorseMapScore:
      return "worse_map_score";
    case InitialPoseReason::kNoTime:
      return "no_time";
  }
  return "unknown";
}

}  // namespace rilo
