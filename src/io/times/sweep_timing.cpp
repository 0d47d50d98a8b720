#include "io/times/sweep_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "io/stamp_difference.hpp"
#include "io/times/sweep_period.hpp"
#include "io/times/time_field.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

// Seconds since 1970 are the usual mistake: float32 has steps of 128 s there.
std::string warning_of_constant(const RawTimes& raw) {
  constexpr float kCoarse = 0.01F;
  std::string warning = "field " + raw.field + " is the same for all points of a sweep: taken as points without times";
  if (raw.type != ScalarType::kFloat32) return warning;
  const auto value = static_cast<float>(raw.floats.front());
  const float step = std::nextafter(value, std::numeric_limits<float>::infinity()) - value;
  if (!(step > kCoarse)) return warning;
  return warning +
         fmt::format(". float32 has steps of {:.3g} at {:.6g}: write float64, or times since the sweep's stamp", step,
                     value);
}

}  // namespace

std::string azimuth_description(SpinDirection direction, double period_s) {
  return "azimuth, " + std::string(to_string(direction)) + ", period " + std::to_string(period_s) + " s";
}

SweepTiming::SweepTiming(const SourceOptions& options, const PointTimeHints& hints, double period_s,
                         bool stamps_assumed)
    : from_(options.point_times),
      for_stamps_(stamps_assumed && (from_ == PointTimes::kNone || from_ == PointTimes::kOrder)),
      spin_(options.spin_direction),
      period_s_(period_s),
      infers_unit_(hints.unit == PointTimeUnit::kInfer),
      stamps_in_field_(hints.reference == PointTimeReference::kEpoch),
      decoder_(hints),
      clock_(hints.period_s, hints.assumed_period_s) {
  if (from_ != PointTimes::kAzimuth) return;
  has_times_ = true;
  description_ = azimuth_description(options.spin_direction, turn_s(period_s));
}

void SweepTiming::promise(const std::optional<std::string>& times, const std::vector<RawTimes>& ends,
                          const std::vector<std::int64_t>& stamps_ns) {
  if (!reads_times()) return;
  decoder_.learn(ends);
  expect_clock(ends, stamps_ns);
  if (for_stamps_) return;
  // Whoever tells the unit wants what is there, but zeros tell nothing.
  const auto tells_nothing = [this](const RawTimes& raw) {
    const bool floating = is_floating(raw.type);
    const bool same = floating ? raw.floats.front() == raw.floats.back() : raw.integers.front() == raw.integers.back();
    return same && (infers_unit_ || (floating ? raw.floats.front() == 0 : raw.integers.front() == 0));
  };
  constant_ = !stamps_in_field_ && !ends.empty() && std::all_of(ends.begin(), ends.end(), tells_nothing);
  has_times_ = times.has_value() && !constant_;
  description_ = has_times_ ? *times : "none";
  if (constant_) constant_warning_ = warning_of_constant(ends.front());
}

// As the sweeps will be decoded. The first sweep may lack times, and what stamps the others shows only then.
void SweepTiming::expect_clock(const std::vector<RawTimes>& ends, const std::vector<std::int64_t>& stamps_ns) {
  constexpr double kLonger = 1.25;  // than a sweep of the assumed period, whose ends may overlap
  constexpr double kLongestPeriodS = 10.0;
  PointTimeDecoder trial = decoder_;
  std::optional<std::int64_t> before_ns;
  double least_step_s = kLongestPeriodS;
  double longest_s = 0;
  for (std::size_t i = 0; i < std::min(ends.size(), stamps_ns.size()); ++i) {
    Sweep sweep;
    sweep.points.assign(ends[i].size(), Eigen::Vector3f::Ones());
    try {
      if (!trial.decode(ends[i], {}, sweep)) continue;
    } catch (const IoError&) {
      continue;  // reported when it is reached
    }
    const auto [first, last] = std::minmax_element(sweep.times_s.begin(), sweep.times_s.end());
    if (first != last) longest_s = std::max(longest_s, static_cast<double>(*last - *first));
    if (trial.convention()->reference != PointTimeReference::kEpoch) continue;
    clock_.expect(stamps_ns[i], sweep.stamp_ns);
    const double step_s = before_ns ? seconds_between(*before_ns, sweep.stamp_ns) : 0.0;
    if (step_s > 0) least_step_s = std::min(least_step_s, step_s);  // others may be gaps
    before_ns = sweep.stamp_ns;
  }
  const bool of_time = trial.convention() && trial.convention()->unit != PointTimeUnit::kFraction;
  if (least_step_s < kLongestPeriodS) {
    shown_period_ = {least_step_s, true};
  } else if (of_time && longest_s > kLonger * period_s_ && longest_s < kLongestPeriodS) {
    shown_period_ = {longest_s, false};
  }
}

void SweepTiming::apply(const std::optional<RawTimes>& times, const std::filesystem::path& file, double forward_after_s,
                        Sweep& sweep) {
  if (for_stamps_) stamp(times, file, sweep);
  if (from_ == PointTimes::kNone || from_ == PointTimes::kOrder) return;  // see with_order_times()
  if (from_ == PointTimes::kAzimuth) {
    sweep.stamp_ns += nanoseconds(forward_after_s);
    sweep.times_s = azimuth_times(sweep.points, turn_s(period_s_), spin_);
    return;
  }
  has_times_ = times.has_value();
  const std::int64_t own_ns = sweep.stamp_ns;
  if (!times) {
    description_ = "none";
    sweep.stamp_ns = clock_.stamp_of(own_ns);
    return;
  }
  if (constant_) {
    const TimeField field(*times, file, sweep.points);
    constant_ = field.empty() || field.bulk().constant();
    has_times_ = !constant_;
    if (constant_) return;
  }
  if (!decoder_.decode(*times, file, sweep)) {
    sweep.stamp_ns = clock_.stamp_of(own_ns);
  } else if (sets_stamps()) {
    clock_.set(own_ns, sweep.stamp_ns);
  }
  if (!decoder_.description().empty()) description_ = decoder_.description();
}

void SweepTiming::stamp(const std::optional<RawTimes>& times, const std::filesystem::path& file, Sweep& sweep) {
  const std::int64_t own_ns = sweep.stamp_ns;
  bool stamped = false;
  try {
    stamped = times && decoder_.decode(*times, file, sweep) && sets_stamps();
  } catch (const IoError&) {
    // Times that the points do not get may make no sense.
  }
  if (stamped) {
    clock_.set(own_ns, sweep.stamp_ns);
  } else {
    sweep.stamp_ns = clock_.stamp_of(own_ns);
  }
  sweep.times_s.clear();
}

std::vector<std::string> SweepTiming::warnings() const {
  std::vector<std::string> warnings;
  if (for_stamps_) return warnings;
  if (!constant_warning_.empty()) warnings.push_back(constant_warning_);
  const auto& convention = decoder_.convention();
  const bool of_a_turn = from_ == PointTimes::kAzimuth || (convention && convention->unit == PointTimeUnit::kFraction);
  if (of_a_turn) note_left_out(period_s_, turn_s(period_s_), warnings);
  if (!decoder_.warning().empty()) warnings.push_back(decoder_.warning());
  return warnings;
}

bool SweepTiming::sets_stamps() const {
  const auto& convention = decoder_.convention();
  return convention && convention->reference == PointTimeReference::kEpoch;
}

}  // namespace rilo::detail
