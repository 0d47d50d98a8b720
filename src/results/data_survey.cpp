#include "results/data_survey.hpp"

#include <algorithm>

#include "cloud/sensor_axis.hpp"
#include "results/unusable_sweeps.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo {

namespace {

constexpr std::size_t kSweepsLookedAt = 50;

void look_at(const Sweep& sweep, DataSurvey& survey) {
  const std::size_t n = sweep.points.size();
  survey.least = survey.read == 0 ? n : std::min(survey.least, n);
  survey.most = std::max(survey.most, n);
  survey.points += n;
  if (survey.read++ == 0) survey.in_order = order_times(sweep.points, 1).has_value();
  const std::size_t stride = std::max<std::size_t>(1, n / 2000);  // enough for percentiles
  std::bitset<kAzimuthSectors> directions;
  for (std::size_t i = 0; i < n; ++i) {
    const bool finite = sweep.points[i].allFinite();
    survey.not_finite += finite ? 0 : 1;
    const bool near_axis = finite && detail::is_near_axis(sweep.points[i]);
    survey.near_axis += near_axis ? 1 : 0;
    if (finite && i % stride == 0) {
      const double range_m = sweep.points[i].cast<double>().norm();
      survey.usable += within_range(range_m, PreprocessConfig{}) ? 1 : 0;
      survey.ranges.push_back(range_m);
      if (!near_axis) directions.set(azimuth_sector(sweep.points[i]));
    }
  }
  survey.directions |= directions;
  survey.sectors_max = std::max(survey.sectors_max, directions.count());
  if (!sweep.times_s.empty()) {
    const auto [begin, end] = std::minmax_element(sweep.times_s.begin(), sweep.times_s.end());
    survey.times_begin = survey.timed ? std::min(survey.times_begin, *begin) : *begin;
    survey.times_end = survey.timed ? std::max(survey.times_end, *end) : *end;
    survey.timed = true;
  }
  for (const std::uint16_t ring : sweep.rings) survey.rings = std::max(survey.rings, static_cast<int>(ring) + 1);
  survey.intensity = survey.intensity || !sweep.intensities.empty();
}

}  // namespace

DataSurvey survey_of(ScanSource& source, bool all) {
  DataSurvey survey;
  const std::size_t total = source.size().value_or(0);
  // Odd: of halves of revolutions in turn, both are looked at.
  const std::size_t step = all || total <= kSweepsLookedAt ? 1 : (total / kSweepsLookedAt) | 1;
  survey.complete = step == 1;
  while (const auto sweep = source.next()) {
    look_at(*sweep, survey);
    survey.stamps.push_back(sweep->stamp_ns);
    // The last one is looked at in any case: its stamp ends the recording.
    const std::size_t left = total - std::min(total, source.current_index() + 1);
    survey.sweeps += 1 + (left > 1 ? source.skip(std::min(step, left) - 1) : 0);
  }
  return survey;
}

}  // namespace rilo
