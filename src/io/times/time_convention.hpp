// What the times of a field mean: inferred from the first sweeps, checked against later ones.
#pragma once

#include "io/times/time_field.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo::detail {

/// A sweep lasts at most so many periods, by jitter.
inline constexpr double kMostOfPeriod = 1.6;
/// A fraction of the period may overshoot by rounding.
inline constexpr double kFractionSlack = 0.01;

/// Of kFraction: `period_s`.
double seconds_per(PointTimeUnit unit, double period_s);

/// As told, or by name, type and span. `bulk`: see TimeField::bulk(). @throws IoError when it is ambiguous, or another
/// unit than the told one is right.
PointTimeUnit unit_of(const TimeField& bulk, const PointTimeHints& hints);

/// As `told`, or by the size of the times; those that advance from sweep to sweep count from an epoch, however near
/// zero. @throws IoError when it is ambiguous.
PointTimeReference reference_of(const TimeField& bulk, PointTimeUnit unit, PointTimeReference told, bool advances);

/// Float32 cannot hold absolute seconds: 1.6e9 s comes in steps of 128 s. @throws IoError
void check_resolution(const TimeField& field);

/// Later sweeps must fit the decision of the first; `scale`: s per unit. @throws IoError
void check_against(const TimeField& field, const PointTimeConvention& convention, double scale);

}  // namespace rilo::detail
