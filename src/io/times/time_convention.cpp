#include "io/times/time_convention.hpp"

#include <array>
#include <limits>

#include <fmt/format.h>

#include "cloud/measured_point.hpp"
#include "io/text.hpp"

namespace rilo::detail {
namespace {

// Without a known period, a sweep lasts between these (s). The range covers less than a factor of 1000, so that at most
// one of s, ms, µs and ns fits; times that start again in every packet (1.3 ms) fit none.
constexpr double kShortestSweep = 0.01;
constexpr double kLongestSweep = 0.55;
// Of a known period: a narrow sector.
constexpr double kLeastOfPeriod = 0.02;
constexpr double kFarthestFromStamp = kFarthestFromStampS;
// Half of the period, without the ends of the times that the bulk lacks.
constexpr double kLeastOfFractions = 0.48;

std::string number(double value) { return fmt::format("{:.10g}", value); }

constexpr const char* kSetUnit =
    "Set point_time_unit (--point-time-unit) to s, ms, us, ns or fraction, or point_times (--point-times) to none to "
    "go without";
constexpr const char* kSetReference =
    "Set point_time_reference (--point-time-reference) to stamp or epoch, or point_times (--point-times) to none";

// Some names have one meaning in the field: Ouster's t and Livox' offset_time are ns.
bool is_nanoseconds_by_name(const RawTimes& raw) {
  const std::string name = lower_case(raw.field);
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

}  // namespace

double seconds_per(PointTimeUnit unit, double period_s) {
  constexpr std::array<double, 5> kSeconds{1, 1, 1e-3, 1e-6, 1e-9};  // kInfer … kNanoseconds
  static_assert(static_cast<std::size_t>(PointTimeUnit::kFraction) == kSeconds.size());
  return unit == PointTimeUnit::kFraction ? period_s : kSeconds[static_cast<std::size_t>(unit)];
}

PointTimeUnit unit_of(const TimeField& bulk, const PointTimeHints& hints) {
  if (hints.unit == PointTimeUnit::kInfer) return infer_unit(bulk, hints.period_s);
  if (!hints.unit_certain) check_told_unit(bulk, hints.unit, hints.period_s);
  return hints.unit;
}

PointTimeReference reference_of(const TimeField& bulk, PointTimeUnit unit, PointTimeReference told, bool advances) {
  if (unit == PointTimeUnit::kFraction) return PointTimeReference::kStamp;
  if (told != PointTimeReference::kInfer) return told;
  const double scale = seconds_per(unit, 1);
  if (!advances && bulk.farthest() * scale <= kFarthestFromStamp) return PointTimeReference::kStamp;
  if (unit == PointTimeUnit::kNanoseconds && size_of(bulk.raw().type) == 4) {
    bulk.reject(
        "less than " + number(kFarthestFromStamp) + " s from the sweep's stamp, since 32 bits of ns wrap after 4.3 s",
        kSetReference);
  }
  if (!advances && bulk.least() * scale < kFarthestFromStamp) {
    bulk.reject("times around 0 (from the stamp) or all far from it (from an epoch)", kSetReference);
  }
  return PointTimeReference::kEpoch;
}

void check_resolution(const TimeField& field) {
  if (field.raw().type != ScalarType::kFloat32) return;
  const double step = field.farthest() * std::numeric_limits<float>::epsilon();
  if (step <= 0.01 * field.span() || field.farthest() <= 1) return;
  field.reject("steps far below the span; float32 has steps of " + number(step) + " there",
               "Record the times as float64, or set point_times (--point-times) to none or azimuth");
}

void check_against(const TimeField& field, const PointTimeConvention& convention, double scale) {
  const bool fraction = convention.unit == PointTimeUnit::kFraction;
  if (fraction && (field.least() < -kFractionSlack || field.most() > 1 + kFractionSlack)) {
    field.reject("fractions of the sweep from 0 to 1", kSetUnit);
  }
  const std::string at_most = "at most " + number(kFarthestFromStamp) + " s";
  const std::string unit(to_string(convention.unit));
  if (field.span() * scale > kFarthestFromStamp) field.reject(at_most + " in " + unit, kSetUnit);
  if (convention.reference == PointTimeReference::kStamp && !fraction &&
      field.farthest() * scale > kFarthestFromStamp) {
    field.reject(at_most + " from the sweep's stamp, in " + unit,
                 "Set point_time_reference (--point-time-reference) to epoch, point_time_unit (--point-time-unit) to "
                 "the right unit, or point_times (--point-times) to none");
  }
}

}  // namespace rilo::detail
