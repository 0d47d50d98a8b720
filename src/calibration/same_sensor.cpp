#include "calibration/same_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "cloud/beam_index.hpp"
#include "cloud/measured_point.hpp"
#include "geometry/degrees.hpp"

namespace rilo {

namespace {

constexpr double kSameRad = 0.5 * kRadPerDeg;  // offsets and near surfaces move the mean of a beam less
constexpr double kNextRad = 0.3 * kRadPerDeg;  // ranges of angles are narrower: a beam may lie in the one beside
constexpr std::size_t kLeastPoints = 10;       // fewer are no beam

struct SeenBeam {
  double elevation_rad = 0;  // mean
  std::size_t points = 0;
};

std::vector<SeenBeam> beams_of(const SweepView& sweep) {
  std::vector<Beam> index;
  BeamIndex().assign(sweep, index);
  std::vector<SeenBeam> seen(kBeams);
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (index[i] >= kBeams || !detail::is_measured(sweep.points[i])) continue;
    const Eigen::Vector3d p = sweep.points[i].cast<double>();
    SeenBeam& beam = seen[index[i]];
    ++beam.points;
    const double elevation_rad = std::atan2(p.z(), p.head<2>().norm());
    beam.elevation_rad += (elevation_rad - beam.elevation_rad) / static_cast<double>(beam.points);
  }
  return seen;
}

std::string degrees(double rad) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.1f deg", rad * kDegPerRad);
  return text;
}

/// Beams of the sweep that are known by index and elevation, beside those that should be.
std::string unknown_beams(const std::vector<std::optional<double>>& known_rad, const std::vector<SeenBeam>& seen,
                          double lowest_rad, double highest_rad) {
  std::size_t same = 0;
  std::size_t compared = 0;
  std::string first;
  for (std::size_t b = 0; b < kBeams; ++b) {
    const double here_rad = seen[b].elevation_rad;
    // A beam that met nothing where the angles were learnt is missing there: such beams are the highest or the lowest.
    const bool beyond = here_rad < lowest_rad - kSameRad || here_rad > highest_rad + kSameRad;
    if (seen[b].points < kLeastPoints || (beyond && !known_rad[b])) continue;
    ++compared;
    if (known_rad[b] && std::abs(*known_rad[b] - here_rad) <= kSameRad) {
      ++same;
    } else if (first.empty()) {
      first = "beam " + std::to_string(b) + " of this sweep lies at " + degrees(here_rad) + ", the calibration has " +
              (known_rad[b] ? "it at " + degrees(*known_rad[b]) : "no such beam");
    }
  }
  if (compared == 0) return "all beams of this sweep lie beyond those of the calibration";
  return 2 * same < compared ? first : std::string();
}

/// Known beams between those of the sweep that have none near them.
std::string missing_beams(const SensorAngles& known, const std::vector<SeenBeam>& seen) {
  std::vector<double> here_rad;
  for (const SeenBeam& beam : seen) {
    if (beam.points >= kLeastPoints) here_rad.push_back(beam.elevation_rad);
  }
  std::sort(here_rad.begin(), here_rad.end());
  std::size_t met = 0;
  std::size_t compared = 0;
  std::string first;
  for (const BeamCorrection& beam : known.beams) {
    if (beam.elevation_rad < here_rad.front() || beam.elevation_rad > here_rad.back()) continue;
    ++compared;
    const auto near = std::lower_bound(here_rad.begin(), here_rad.end(), beam.elevation_rad - kNextRad);
    if (*near <= beam.elevation_rad + kNextRad) {
      ++met;
    } else if (first.empty()) {
      first = "this sweep has no beam at " + degrees(beam.elevation_rad) + ", the calibration has one";
    }
  }
  return 2 * met < compared ? first : std::string();
}

}  // namespace

std::optional<std::string> other_sensor(const SensorAngles& known, const SweepView& sweep) {
  if (known.beams.empty()) return "";
  const std::vector<SeenBeam> seen = beams_of(sweep);
  const bool any = std::any_of(seen.begin(), seen.end(), [](const SeenBeam& b) { return b.points >= kLeastPoints; });
  if (!any) return std::nullopt;
  std::vector<std::optional<double>> known_rad(kBeams);
  double lowest_rad = known.beams.front().elevation_rad;
  double highest_rad = lowest_rad;
  for (const BeamCorrection& beam : known.beams) {
    if (beam.beam < kBeams) known_rad[beam.beam] = beam.elevation_rad;
    lowest_rad = std::min(lowest_rad, beam.elevation_rad);
    highest_rad = std::max(highest_rad, beam.elevation_rad);
  }
  const std::string unknown = unknown_beams(known_rad, seen, lowest_rad, highest_rad);
  return unknown.empty() ? missing_beams(known, seen) : unknown;
}

void check_reading(const SensorAngles& known, double elevation_correction_deg) {
  if (known.elevation_correction_deg.value_or(elevation_correction_deg) == elevation_correction_deg) return;
  std::ostringstream text;
  text << name_of(known) << ": learnt from data read with an elevation correction of "
       << *known.elevation_correction_deg << " deg, which its angles come on top of; here it is "
       << elevation_correction_deg << " deg. Give the same";
  throw std::invalid_argument(text.str());
}

std::string name_of(const SensorAngles& known) { return known.name.empty() ? "calibration" : known.name; }

}  // namespace rilo
