#include "rilo/io/point_times.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "io/measured_point.hpp"
#include "io/stamp_difference.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using detail::is_measured;  // the time of another point means nothing

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

// One sweep's field and what can be said about it.
class TimeField {
 public:
  TimeField(const RawTimes& raw, const std::filesystem::path& file, const Sweep& sweep)
      : raw_(raw), file_(file), floating_(is_floating(raw.type)) {
    for (std::size_t i = 0; i < sweep.points.size(); ++i) {
      if (!is_measured(sweep.points[i]) || !std::isfinite(value(i))) continue;
      first_ = count_ == 0 || less(i, first_) ? i : first_;
      last_ = count_ == 0 || less(last_, i) ? i : last_;
      ++count_;
    }
  }

  bool empty() const { return count_ == 0; }
  double value(std::size_t i) const { return floating_ ? raw_.floats[i] : static_cast<double>(raw_.integers[i]); }
  /// Exact for integers, however far they are from zero.
  double since_first(std::size_t i) const {
    if (floating_) return raw_.floats[i] - raw_.floats[first_];
    return difference(raw_.integers[i], raw_.integers[first_]);
  }
  double least() const { return value(first_); }
  double most() const { return value(last_); }
  double span() const { return since_first(last_); }
  double farthest() const { return std::max(std::abs(least()), std::abs(most())); }
  std::size_t first() const { return first_; }
  const RawTimes& raw() const { return raw_; }
  std::string name() const { return raw_.field + " (" + std::string(to_string(raw_.type)) + ")"; }

  std::string numbers() const {
    return "point times in field " + name() + " from " + number(least()) + " to " + number(most()) + ", a span of " +
           number(span());
  }
  [[noreturn]] void reject(const std::string& why, const std::string& remedy) const {
    throw IoError({file_, "", numbers(), why, remedy});
  }

 private:
  bool less(std::size_t a, std::size_t b) const {
    return floating_ ? raw_.floats[a] < raw_.floats[b] : raw_.integers[a] < raw_.integers[b];
  }
  static double difference(std::int64_t a, std::int64_t b) {
    std::int64_t exact = 0;
    if (!__builtin_sub_overflow(a, b, &exact)) return static_cast<double>(exact);
    return static_cast<double>(a) - static_cast<double>(b);
  }

  const RawTimes& raw_;
  const std::filesystem::path& file_;
  bool floating_;
  std::size_t count_ = 0;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
};

constexpr const char* kSetUnit =
    "Set point_time_unit to s, ms, us, ns or fraction, or point_times to none to go without";

// Float32 cannot hold absolute seconds: 1.6e9 s comes in steps of 128 s.
void check_resolution(const TimeField& field) {
  if (field.raw().type != ScalarType::kFloat32) return;
  const double step = field.farthest() * std::numeric_limits<float>::epsilon();
  if (step <= 0.01 * field.span() || field.farthest() <= 1) return;
  field.reject("steps far below the span; float32 has steps of " + number(step) + " there",
               "Record the times as float64, or set point_times to none or azimuth");
}

// Some names have one meaning in the field: Ouster's t and Livox' offset_time are ns.
bool is_nanoseconds_by_name(const RawTimes& raw) {
  const std::string name = detail::lower_case(raw.field);
  return !is_floating(raw.type) && (name == "t" || name == "offset_time");
}

bool looks_like_fraction(const TimeField& field) {
  return is_floating(field.raw().type) && field.least() >= -kFractionSlack && field.most() <= 1 + kFractionSlack &&
         field.span() > 0.5;
}

PointTimeUnit infer_unit(const TimeField& field, const std::optional<double>& period_s) {
  const double shortest = period_s ? kLeastOfPeriod * *period_s : kShortestSweep;
  const double longest = period_s ? kMostOfPeriod * *period_s : kLongestSweep;
  std::optional<PointTimeUnit> fitting;
  for (const auto unit : {PointTimeUnit::kSeconds, PointTimeUnit::kMilliseconds, PointTimeUnit::kMicroseconds,
                          PointTimeUnit::kNanoseconds}) {
    const double span_s = field.span() * seconds_per(unit, 1);
    // Whole seconds tell no points apart.
    if (unit == PointTimeUnit::kSeconds && !is_floating(field.raw().type)) continue;
    if (span_s >= shortest && span_s <= longest) fitting = unit;
  }
  const std::string range = number(shortest) + " to " + number(longest) + " s";
  if (looks_like_fraction(field)) {
    if (!fitting && period_s) return PointTimeUnit::kFraction;
    field.reject("either seconds or fractions of the sweep; both are possible", kSetUnit);
  }
  if (is_nanoseconds_by_name(field.raw())) {
    if (fitting && *fitting != PointTimeUnit::kNanoseconds) {
      field.reject("nanoseconds by the field's name, but the span fits a sweep of " + range + " only in " +
                       std::string(to_string(*fitting)),
                   kSetUnit);
    }
    if (field.span() * 1e-9 <= longest) return PointTimeUnit::kNanoseconds;
  }
  if (!fitting) field.reject("a sweep of " + range + " in s, ms, us or ns", kSetUnit);
  return *fitting;
}

PointTimeReference infer_reference(const TimeField& field, PointTimeUnit unit, double scale) {
  const double farthest_s = field.farthest() * scale;
  if (unit == PointTimeUnit::kFraction || farthest_s <= kFarthestFromStamp) return PointTimeReference::kStamp;
  const bool wraps = unit == PointTimeUnit::kNanoseconds && size_of(field.raw().type) == 4;
  if (wraps) {
    field.reject(
        "less than " + number(kFarthestFromStamp) + " s from the sweep's stamp, since 32 bits of ns wrap after 4.3 s",
        "Set point_time_reference to stamp or epoch, or point_times to none");
  }
  if (field.least() * scale < kFarthestFromStamp) {
    field.reject("times around 0 (from the stamp) or all far from it (from an epoch)",
                 "Set point_time_reference to stamp or epoch, or point_times to none");
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
    field.reject("stamps that fit into 64 bits of ns", "Set point_time_unit to the unit of the times");
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
                 "Set point_time_reference to epoch, point_time_unit to the right unit, or point_times to none");
  }
}

void fill(const TimeField& field, bool from_first, double scale, Sweep& sweep) {
  sweep.times_s.assign(sweep.points.size(), 0.0F);
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (!is_measured(sweep.points[i])) continue;
    const double time = from_first ? field.since_first(i) : field.value(i);
    if (std::isfinite(time)) {
      sweep.times_s[i] = static_cast<float>(time * scale);
    } else {
      sweep.points[i].setConstant(std::numeric_limits<float>::quiet_NaN());
    }
  }
}

}  // namespace

void PointTimeDecoder::decode(const RawTimes& raw, const std::filesystem::path& file, Sweep& sweep) {
  if (raw.size() != sweep.points.size()) {
    throw std::invalid_argument("PointTimeDecoder: as many times as points are needed");
  }
  const TimeField field(raw, file, sweep);
  const double period_s = hints_.period_s.value_or(hints_.assumed_period_s);
  const auto scale_of = [&](PointTimeUnit unit) { return seconds_per(unit, period_s); };
  if (field.empty()) {
    // Nothing measured, or nothing timed: with zero scale, measured points still become NaN.
    fill(field, false, 0, sweep);
    return;
  }
  PointTimeConvention convention = convention_.value_or(PointTimeConvention{hints_.unit, hints_.reference});
  const bool all_zero = field.span() == 0 && field.least() == 0;
  if (!convention_ && all_zero && hints_.unit == PointTimeUnit::kInfer) {
    fill(field, false, 0, sweep);
    return;
  }
  check_resolution(field);
  if (convention.unit == PointTimeUnit::kInfer) convention.unit = infer_unit(field, hints_.period_s);
  const double scale = scale_of(convention.unit);
  if (convention.reference == PointTimeReference::kInfer || convention.unit == PointTimeUnit::kFraction) {
    convention.reference = infer_reference(field, convention.unit, scale);
  }
  check_against(field, convention, scale);
  const bool from_epoch = convention.reference == PointTimeReference::kEpoch;
  if (from_epoch) sweep.stamp_ns = epoch_stamp_ns(field, scale);
  fill(field, from_epoch, scale, sweep);
  convention_ = convention;
  description_ = describe(field, convention);
}

std::int64_t pose_stamp_ns(std::int64_t middle_ns, std::int64_t sweep_stamp_ns) {
  constexpr std::int64_t kMicrosecond = 1000;
  const std::int64_t apart = detail::stamp_difference(middle_ns, sweep_stamp_ns);
  return apart >= -kMicrosecond && apart <= kMicrosecond ? sweep_stamp_ns : middle_ns;
}

std::vector<float> azimuth_times(const std::vector<Eigen::Vector3f>& points, double period_s, SpinDirection direction) {
  const double per_radian = (direction == SpinDirection::kClockwise ? -period_s : period_s) / (2 * std::numbers::pi);
  std::vector<float> times(points.size(), 0.0F);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double azimuth = std::atan2(static_cast<double>(points[i].y()), static_cast<double>(points[i].x()));
    if (std::isfinite(azimuth)) times[i] = static_cast<float>(azimuth * per_radian);
  }
  return times;
}

}  // namespace rilo
