#include "python_odometry.hpp"

#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "arrays.hpp"
#include "notebook.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"
#include "settings.hpp"

namespace rilo::python {

namespace {

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

constexpr auto kAssumedPeriodNs = static_cast<std::int64_t>(kAssumedPeriodS * 1e9);

RawTimes raw_times_of(const py::object& object, std::size_t points) {
  const py::array array = array_of(object, "timestamps");
  const char kind = array.dtype().kind();
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != points ||
      (kind != 'f' && kind != 'i' && kind != 'u')) {
    throw py::value_error("timestamps: got " + description_of(array) + "; expected shape (" + std::to_string(points) +
                          ",), one number per point");
  }
  RawTimes raw;
  raw.field = "timestamps";
  if (kind == 'f') {
    raw.type = array.itemsize() == 4 ? ScalarType::kFloat32 : ScalarType::kFloat64;
    const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>(array);
    raw.floats.assign(numbers.data(), numbers.data() + numbers.size());
  } else {
    raw.type = array.itemsize() <= 4 ? ScalarType::kUint32 : ScalarType::kInt64;
    raw.integers = integers_of(array, "timestamps");
  }
  return raw;
}

/// A stamp of any kind of integer.
std::optional<std::int64_t> stamp_of(const py::object& object) {
  if (object.is_none()) return std::nullopt;
  if (PyIndex_Check(object.ptr()) == 0) {
    refuse_type("stamp_ns", object, "a whole number of ns, or None. Of seconds: round(seconds * 1e9)");
  }
  try {
    return object.cast<std::int64_t>();
  } catch (const py::cast_error&) {
    throw py::value_error("stamp_ns: got " + py::str(object).cast<std::string>() + "; expected ns that fit 64 bits");
  }
}

// As in the readers: farther from the stamp, times are in another unit or of a clock.
constexpr float kFarthestFromStampS = 2.5F;

/// @throws ValueError when a point that was measured has a time that is not one of a sweep.
void check_seconds(std::span<const float> times_s, std::span<const Eigen::Vector3f> points) {
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    if (!std::isfinite(times_s[i]) || std::abs(times_s[i]) <= kFarthestFromStampS) continue;
    if (!points[i].allFinite() || points[i] == Eigen::Vector3f::Zero()) continue;
    throw py::value_error(
        text_of("times_s: got %g at index %zu; expected seconds from stamp_ns, at most %g. Times in other units, of a "
                "clock, or with single wrong ones: register_frame(points, timestamps)",
                static_cast<double>(times_s[i]), i, static_cast<double>(kFarthestFromStampS)));
  }
}

}  // namespace

PythonOdometry::PythonOdometry(const py::object& config, const py::object& settings, const py::object& calibration)
    : config_(config_of(config, settings)), odometry_(config_, monotonic_ns) {
  if (const auto known = calibration_of(calibration)) odometry_.start_with(*known);
}

SweepResult PythonOdometry::register_sweep(const py::object& points, const py::object& times_s,
                                           const py::object& stamp_ns, const py::object& rings) {
  const std::optional<std::int64_t> stamp = stamp_of(stamp_ns);
  const auto taken = points_of(points);
  std::optional<Column<float>> times;
  std::optional<Column<std::uint16_t>> beams;
  SweepView sweep;
  sweep.points = taken.values;
  if (!times_s.is_none()) sweep.times_s = times.emplace(times_of(times_s, taken.values.size())).values;
  check_seconds(sweep.times_s, sweep.points);
  if (!rings.is_none()) sweep.rings = beams.emplace(rings_of(rings, taken.values.size())).values;
  const Held held(mutex_);
  sweep.stamp_ns = stamp.value_or(next_stamp_ns());
  return registered(sweep);
}

SweepResult PythonOdometry::register_frame(const py::object& points, const py::object& timestamps,
                                           const py::object& stamp_ns, const std::string& unit) {
  const std::optional<std::int64_t> stamp = stamp_of(stamp_ns);
  const auto taken = points_of(points);
  const auto parsed = parse_point_time_unit(unit);
  if (!parsed) {
    throw py::value_error("point_time_unit: got '" + unit + "'; expected infer, s, ms, us, ns or fraction");
  }
  std::optional<RawTimes> raw;
  if (!timestamps.is_none()) raw = raw_times_of(timestamps, taken.values.size());
  const Held held(mutex_);
  SweepView view;
  view.points = taken.values;
  view.stamp_ns = stamp.value_or(next_stamp_ns());
  if (!raw) return registered(view);
  Sweep sweep;  // the decoder marks points without a time, so it has its own
  sweep.points.assign(taken.values.begin(), taken.values.end());
  sweep.stamp_ns = view.stamp_ns;
  try {
    frame_times_.decode(*raw, *parsed, stamp, sweep);
  } catch (const IoError& error) {  // of a file elsewhere: here it is the caller's array
    throw py::value_error("timestamps: " + error.problem().found + "; expected " + error.problem().expected +
                          ". Give point_time_unit, or none to go without them");
  }
  if (stamp) sweep.stamp_ns = *stamp;
  return registered(sweep);
}

void PythonOdometry::reset() {
  const Held held(mutex_);
  odometry_.reset();
  forget_times();
}

double PythonOdometry::start_over() {
  const Held held(mutex_);
  forget_times();
  return odometry_.start_over();
}

void PythonOdometry::forget_times() {
  last_stamp_ns_.reset();
  frame_times_.forget();
}

std::int64_t PythonOdometry::next_stamp_ns() const { return last_stamp_ns_ ? *last_stamp_ns_ + kAssumedPeriodNs : 0; }

SweepResult PythonOdometry::registered(const SweepView& sweep) {
  last_stamp_ns_ = sweep.stamp_ns;
  return odometry_.register_sweep(sweep);
}

}  // namespace rilo::python
