#include "rilo/io/point_times.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "io/clouds/measured_point.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "io/times/time_field.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using detail::is_measured;  // the time of another point means nothing
using detail::TimeField;

// Without a known period, a sweep lasts between these (s). The range covers less than a factor of 1000, so that at most
// one of s, ms, µs and ns fits; times that start again in every packet (1.3 ms) fit none.
constexpr double kShortestSweep = 0.01;
constexpr double kLongestSweep = 0.55;
// Around a known period: a narrow sector at one end, jitter at the other.
constexpr double kLeastOfPeriod = 0.02;
constexpr double kMostOfPeriod = 1.6;
// Farther from zero than this (s), times cannot count from the sweep's stamp.
constexpr double kFarthestFromStamp = 2.5;
// A fraction of the period may overshoot by rounding.
constexpr double kFractionSlack = 0.01;
// Half of the period, without the ends of the times that the bulk lacks.
constexpr double kLeastOfFractions = 0.48;

double seconds_per(PointTimeUnit unit, double period_s) {
  switch (unit) {
    case PointTimeUnit::kMilliseconds:
      return 1e-3;
    case PointTimeUnit::kMicroseconds:
      return 1e-6;
    case PointTimeUnit::kNanoseconds:
      return 1e-9;
    case PointTimeUnit::kFraction:
      return period_s;
    case PointTimeUnit::kInfer:
    case PointTimeUnit::kSeconds:
      break;
  }
  return 1;
}

std::string number(double value) { return fmt::format("{:.10g}", value); }

constexpr const char* kSetUnit =
    "Set point_time_unit (--point-time-unit) to s, ms, us, ns or fraction, or point_times (--point-times) to none to "
    "go without";

// Float32 cannot hold absolute seconds: 1.6e9 s comes in steps of 128 s.
void check_resolution(const TimeField& field) {
  if (field.raw().type != ScalarType::kFloat32) return;
  const double step = field.farthest() * std::numeric_limits<float>::epsilon();
  if (step <= 0.01 * field.span() || field.farthest() <= 1) return;
  field.reject("steps far below the span; float32 has steps of " + number(step) + " there",
               "Record the times as float64, or set point_times (--point-times) to none or azimuth");
}

// Some names have one meaning in the field: Ouster's t and Livox' offset_time are ns.
bool is_nanoseconds_by_name(const RawTimes& raw) {
  const std::string name = detail::lower_case(raw.field);
  return !is_floating(raw.type) && (name == "t" || name == "offset_time");
}

bool looks_like_fraction(const TimeField& field) {
  return is_floating(field.raw().type) && field.least() >= -kFractionSlack && field.most() <= 1 + kFractionSlack &&
         field.span() > kLeastOfFractions;
}

struct SweepLength {
  double shortest_s;
  double longest_s;

  explicit SweepLength(const std::optional<double>& period_s)
      : shortest_s(period_s ? kLeastOfPeriod * *period_s : kShortestSweep),
        longest_s(period_s ? kMostOfPeriod * *period_s : kLongestSweep) {}

  bool holds(double span_s) const { return span_s >= shortest_s && span_s <= longest_s; }
  std::string text() const { return "a sweep of " + number(shortest_s) + " to " + number(longest_s) + " s"; }
};

std::optional<PointTimeUnit> fitting_unit(const TimeField& field, const SweepLength& length) {
  for (const auto unit : {PointTimeUnit::kSeconds, PointTimeUnit::kMilliseconds, PointTimeUnit::kMicroseconds,
                          PointTimeUnit::kNanoseconds}) {
    // Whole seconds tell no points apart.
    if (unit == PointTimeUnit::kSeconds && !is_floating(field.raw().type)) continue;
    if (length.holds(field.span() * seconds_per(unit, 1))) return unit;
  }
  return std::nullopt;
}

// `field`: the bulk of the times, as below.
PointTimeUnit infer_unit(const TimeField& field, const std::optional<double>& period_s) {
  const SweepLength length(period_s);
  const std::optional<PointTimeUnit> fitting = fitting_unit(field, length);
  if (looks_like_fraction(field)) {
    if (!fitting && period_s) return PointTimeUnit::kFraction;
    field.reject("either seconds or fractions of the sweep; both are possible", kSetUnit);
  }
  if (is_nanoseconds_by_name(field.raw())) {
    if (fitting && *fitting != PointTimeUnit::kNanoseconds) {
      field.reject("nanoseconds by the field's name, but the span fits " + length.text() + " only in " +
                       std::string(to_string(*fitting)),
                   kSetUnit);
    }
    if (field.span() * 1e-9 <= length.longest_s) return PointTimeUnit::kNanoseconds;
  }
  if (!fitting) field.reject(length.text() + " in s, ms, us or ns", kSetUnit);
  return *fitting;
}

// A unit that is told is taken unless another one is right.
void check_told_unit(const TimeField& field, PointTimeUnit told, const std::optional<double>& period_s) {
  const SweepLength length(period_s);
  if (told == PointTimeUnit::kFraction || length.holds(field.span() * seconds_per(told, 1))) return;
  std::optional<PointTimeUnit> fitting = fitting_unit(field, length);
  if (!fitting && period_s && looks_like_fraction(field)) fitting = PointTimeUnit::kFraction;
  if (!fitting) return;
  field.reject("in " + std::string(to_string(told)) + ", as point_time_unit says, " + length.text() +
                   "; the span is one in " + std::string(to_string(*fitting)),
               "Set point_time_unit (--point-time-unit) to " + std::string(to_string(*fitting)) + ", or leave it out");
}

PointTimeUnit unit_of(const TimeField& bulk, const PointTimeHints& hints) {
  if (hints.unit == PointTimeUnit::kInfer) return infer_unit(bulk, hints.period_s);
  if (!hints.unit_certain) check_told_unit(bulk, hints.unit, hints.period_s);
  return hints.unit;
}

[[noreturn]] void reject_wrapping(const TimeField& field) {
  field.reject(
      "less than " + number(kFarthestFromStamp) + " s from the sweep's stamp, since 32 bits of ns wrap after 4.3 s",
      "Set point_time_reference (--point-time-reference) to stamp or epoch, or point_times (--point-times) to none");
}

bool wraps(const TimeField& field, PointTimeUnit unit) {
  return unit == PointTimeUnit::kNanoseconds && size_of(field.raw().type) == 4;
}

PointTimeReference infer_reference(const TimeField& field, PointTimeUnit unit, double scale) {
  const double farthest_s = field.farthest() * scale;
  if (farthest_s <= kFarthestFromStamp) return PointTimeReference::kStamp;
  if (wraps(field, unit)) reject_wrapping(field);
  if (field.least() * scale < kFarthestFromStamp) {
    field.reject(
        "times around 0 (from the stamp) or all far from it (from an epoch)",
        "Set point_time_reference (--point-time-reference) to stamp or epoch, or point_times (--point-times) to none");
  }
  return PointTimeReference::kEpoch;
}

std::string describe(const TimeField& field, const PointTimeConvention& convention) {
  const bool fraction = convention.unit == PointTimeUnit::kFraction;
  return "field " + field.name() + ", " +
         (fraction ? "fraction of the sweep" : std::string(to_string(convention.unit))) +
         (convention.reference == PointTimeReference::kEpoch ? " since an epoch" : " since the sweep's stamp");
}

// The time of the earliest point in ns.
std::int64_t epoch_stamp_ns(const TimeField& field, double scale) {
  const double stamp_s = field.least() * scale;
  if (std::abs(stamp_s) > 9.2e9) {
    field.reject("stamps that fit into 64 bits of ns",
                 "Set point_time_unit (--point-time-unit) to the unit of the times");
  }
  if (is_floating(field.raw().type)) return std::llround(field.least() * (scale * 1e9));
  return field.raw().integers[field.first()] * static_cast<std::int64_t>(std::llround(scale * 1e9));
}

// Later sweeps must fit the decision of the first.
void check_against(const TimeField& field, const PointTimeConvention& convention, double scale) {
  const bool fraction = convention.unit == PointTimeUnit::kFraction;
  if (fraction && (field.least() < -kFractionSlack || field.most() > 1 + kFractionSlack)) {
    field.reject("fractions of the sweep from 0 to 1", kSetUnit);
  }
  if (field.span() * scale > kFarthestFromStamp) {
    field.reject("at most " + number(kFarthestFromStamp) + " s in " + std::string(to_string(convention.unit)),
                 kSetUnit);
  }
  if (convention.reference == PointTimeReference::kStamp && !fraction &&
      field.farthest() * scale > kFarthestFromStamp) {
    field.reject("at most " + number(kFarthestFromStamp) + " s from the sweep's stamp, in " +
                     std::string(to_string(convention.unit)),
                 "Set point_time_reference (--point-time-reference) to epoch, point_time_unit (--point-time-unit) to "
                 "the right unit, or point_times (--point-times) to none");
  }
}

// Returns how many finite times are outside of `field`.
std::size_t fill(const TimeField& field, bool from_first, double scale, Sweep& sweep) {
  std::size_t outside = 0;
  sweep.times_s.assign(sweep.points.size(), 0.0F);
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (!is_measured(sweep.points[i])) continue;
    if (field.holds(i)) {
      sweep.times_s[i] = static_cast<float>((from_first ? field.since_first(i) : field.value(i)) * scale);
    } else {
      outside += std::isfinite(field.value(i)) ? 1 : 0;
      sweep.points[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
  }
  return outside;
}

// Of the first sweep with such times: more would say the same.
std::string warning_of(const TimeField& field, double scale, std::size_t outside,
                       const std::optional<double>& period_s) {
  if (outside > 0) {
    return fmt::format(
        "{}: {} of {} points have times too far from those of the others to be of the same sweep: they are not used, "
        "nor are such in later sweeps",
        field.file().string(), outside, field.raw().size());
  }
  const double span_s = field.span() * scale;
  if (!period_s || span_s <= kMostOfPeriod * *period_s) return {};
  return fmt::format("{}: the times of its points span {:.3g} s, where sweeps come every {:.3g} s",
                     field.file().string(), span_s, *period_s);
}

}  // namespace

void PointTimeDecoder::learn(const std::vector<RawTimes>& ends) {
  const std::filesystem::path none;
  const std::vector<Eigen::Vector3f> two(2, Eigen::Vector3f::Ones());
  double widest = 0;
  double first_start = 0;
  double last_start = 0;
  std::size_t starts = 0;
  for (const RawTimes& raw : ends) {
    const TimeField field(raw, none, two);
    if (field.constant()) continue;
    last_start = field.least();
    if (starts++ == 0) first_start = last_start;
    if (field.span() <= widest) continue;
    try {
      learnt_unit_ = unit_of(field, hints_);
      widest = field.span();
    } catch (const IoError&) {
      // This sweep does not show it. When none does, decode() says why.
    }
  }
  // Half: sweeps in parts count from the start of the whole one, again and again.
  advances_ = learnt_unit_ && starts > 2 && last_start - first_start > 0.5 * widest * static_cast<double>(starts - 1);
}

PointTimeConvention PointTimeDecoder::convention_of(const RawTimes& raw, const std::filesystem::path& file,
                                                    const Sweep& sweep) const {
  const TimeField bulk = TimeField(raw, file, sweep.points).bulk();
  check_resolution(bulk);
  PointTimeConvention convention{learnt_unit_ ? *learnt_unit_ : unit_of(bulk, hints_), hints_.reference};
  if (convention.unit == PointTimeUnit::kFraction) {
    convention.reference = PointTimeReference::kStamp;
  } else if (convention.reference == PointTimeReference::kInfer && advances_) {
    if (wraps(bulk, convention.unit)) reject_wrapping(bulk);
    convention.reference = PointTimeReference::kEpoch;
  } else if (convention.reference == PointTimeReference::kInfer) {
    convention.reference = infer_reference(bulk, convention.unit, seconds_per(convention.unit, 1));
  }
  return convention;
}

void PointTimeDecoder::decode(const RawTimes& raw, const std::filesystem::path& file, Sweep& sweep) {
  if (raw.size() != sweep.points.size()) {
    throw std::invalid_argument("PointTimeDecoder: as many times as points are needed");
  }
  const TimeField all(raw, file, sweep.points);
  if (all.empty()) {
    // Nothing measured, or nothing timed: with zero scale, measured points still become NaN.
    fill(all, false, 0, sweep);
    return;
  }
  const bool all_zero = all.constant() && all.least() == 0;
  const bool undecided = !convention_ && hints_.unit == PointTimeUnit::kInfer;
  if (all_zero && (undecided || (convention_ && convention_->reference == PointTimeReference::kEpoch))) {
    fill(all, false, 0, sweep);
    return;
  }
  const PointTimeConvention convention = convention_ ? *convention_ : convention_of(raw, file, sweep);
  const double period_s = hints_.period_s.value_or(hints_.assumed_period_s);
  const double scale = seconds_per(convention.unit, period_s);
  const TimeField field = convention.unit == PointTimeUnit::kFraction ? all.between(-kFractionSlack, 1 + kFractionSlack)
                                                                      : all.of_one_sweep(period_s / scale);
  check_resolution(field);
  check_against(field, convention, scale);
  const bool from_epoch = convention.reference == PointTimeReference::kEpoch;
  if (from_epoch) sweep.stamp_ns = epoch_stamp_ns(field, scale);
  const std::size_t outside = fill(field, from_epoch, scale, sweep);
  if (warning_.empty()) warning_ = warning_of(field, scale, outside, hints_.period_s);
  convention_ = convention;
  description_ = describe(field, convention);
}

std::int64_t pose_stamp_ns(std::int64_t middle_ns, std::int64_t sweep_stamp_ns) {
  constexpr std::int64_t kMicrosecond = 1000;
  const std::int64_t apart = detail::stamp_difference(middle_ns, sweep_stamp_ns);
  return apart >= -kMicrosecond && apart <= kMicrosecond ? sweep_stamp_ns : middle_ns;
}

}  // namespace rilo
