#include "rilo/io/point_times.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>

#include "cloud/measured_point.hpp"
#include "io/stamp_difference.hpp"
#include "io/times/sweep_period.hpp"
#include "io/times/time_convention.hpp"
#include "io/times/time_field.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {
namespace {

using detail::is_measured;  // the time of another point means nothing
using detail::kFractionSlack;
using detail::kMostOfPeriod;
using detail::TimeField;

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
      learnt_unit_ = detail::unit_of(field, hints_);
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
  detail::check_resolution(bulk);
  const PointTimeUnit unit = learnt_unit_ ? *learnt_unit_ : detail::unit_of(bulk, hints_);
  return {unit, detail::reference_of(bulk, unit, hints_.reference, advances_)};
}

bool PointTimeDecoder::decode(const RawTimes& raw, const std::filesystem::path& file, Sweep& sweep) {
  if (raw.size() != sweep.points.size()) {
    throw std::invalid_argument("PointTimeDecoder: as many times as points are needed");
  }
  const TimeField all(raw, file, sweep.points);
  const bool all_zero = all.constant() && all.least() == 0;
  const bool undecided = !convention_ && hints_.unit == PointTimeUnit::kInfer;
  if (all.empty() ||
      (all_zero && (undecided || (convention_ && convention_->reference == PointTimeReference::kEpoch)))) {
    // Nothing measured, nothing timed, or nothing said: with zero scale, measured points without a time become NaN.
    fill(all, false, 0, sweep);
    return false;
  }
  const PointTimeConvention convention = convention_ ? *convention_ : convention_of(raw, file, sweep);
  const double period_s = hints_.period_s.value_or(hints_.assumed_period_s);
  const double scale = detail::seconds_per(convention.unit, detail::turn_s(period_s));
  const TimeField field = convention.unit == PointTimeUnit::kFraction ? all.between(-kFractionSlack, 1 + kFractionSlack)
                                                                      : all.of_one_sweep(period_s / scale);
  detail::check_resolution(field);
  detail::check_against(field, convention, scale);
  const bool from_epoch = convention.reference == PointTimeReference::kEpoch;
  if (from_epoch) sweep.stamp_ns = epoch_stamp_ns(field, scale);
  const std::size_t outside = fill(field, from_epoch, scale, sweep);
  if (warning_.empty()) warning_ = warning_of(field, scale, outside, hints_.period_s);
  convention_ = convention;
  description_ = describe(field, convention);
  return true;
}

std::int64_t pose_stamp_ns(std::int64_t middle_ns, std::int64_t sweep_stamp_ns) {
  constexpr std::int64_t kMicrosecond = 1000;
  const std::int64_t apart = detail::stamp_difference(middle_ns, sweep_stamp_ns);
  return apart >= -kMicrosecond && apart <= kMicrosecond ? sweep_stamp_ns : middle_ns;
}

}  // namespace rilo
