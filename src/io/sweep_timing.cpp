#include "io/sweep_timing.hpp"

#include <cmath>

namespace rilo::detail {

SweepTiming::SweepTiming(const SourceOptions& options, const PointTimeHints& hints, double period_s)
    : from_(options.point_times), spin_(options.spin_direction), period_s_(period_s), decoder_(hints) {
  if (from_ != PointTimes::kAzimuth) return;
  has_times_ = true;
  description_ =
      "azimuth, " + std::string(to_string(options.spin_direction)) + ", period " + std::to_string(period_s) + " s";
}

void SweepTiming::promise(const std::optional<std::string>& times) {
  if (from_ != PointTimes::kAuto) return;
  has_times_ = times.has_value();
  description_ = times.value_or("none");
}

void SweepTiming::apply(const std::optional<RawTimes>& times, const std::filesystem::path& file, double forward_after_s,
                        Sweep& sweep) {
  if (from_ == PointTimes::kNone || from_ == PointTimes::kOrder) return;  // see with_order_times()
  if (from_ == PointTimes::kAzimuth) {
    sweep.stamp_ns += std::llround(forward_after_s * 1e9);
    sweep.times_s = azimuth_times(sweep.points, period_s_, spin_);
    return;
  }
  has_times_ = times.has_value();
  if (!times) {
    description_ = "none";
    return;
  }
  decoder_.decode(*times, file, sweep);
  if (!decoder_.description().empty()) description_ = decoder_.description();
}

bool SweepTiming::sets_stamps() const {
  const auto& convention = decoder_.convention();
  return convention && convention->reference == PointTimeReference::kEpoch;
}

}  // namespace rilo::detail
