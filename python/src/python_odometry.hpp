// An odometry as Python calls it: arrays in, what its calls leave unsaid filled in.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <pybind11/pybind11.h>
#include <string>

#include "frame_times.hpp"
#include "held.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::python {

/// Any thread may call it.
class PythonOdometry {
 public:
  /// @throws as config_of() and calibration_of().
  PythonOdometry(const pybind11::object& config, const pybind11::object& settings, const pybind11::object& calibration);

  /// @throws ValueError, TypeError for arrays and stamps that are none, and for times that are no seconds of a sweep.
  SweepResult register_sweep(const pybind11::object& points, const pybind11::object& times_s,
                             const pybind11::object& stamp_ns, const pybind11::object& rings);

  /// @throws ValueError, TypeError as above, IoError for timestamps whose unit cannot be told.
  SweepResult register_frame(const pybind11::object& points, const pybind11::object& timestamps,
                             const pybind11::object& stamp_ns, const std::string& unit);

  void reset();
  double start_over();

  /// What `function` makes of the odometry, without Python's lock.
  template <typename Function>
  auto read(const Function& function) const {
    const Held held(mutex_);
    return function(odometry_);
  }
  const OdometryConfig& config() const { return config_; }

 private:
  // With the odometry held.
  void forget_times();
  std::int64_t next_stamp_ns() const;
  SweepResult registered(const SweepView& sweep);

  OdometryConfig config_;
  mutable std::mutex mutex_;  // for all that follows
  Odometry odometry_;
  std::optional<std::int64_t> last_stamp_ns_;
  FrameTimes frame_times_;
};

}  // namespace rilo::python
