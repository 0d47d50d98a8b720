// Odometry, its configuration and its results.
#include <chrono>
#include <optional>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/odometry/odometry.hpp"

namespace rilo::python {

namespace {

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// YAML text, a path to a file (what ends in .yaml or .yml), or nothing: the defaults.
OdometryConfig config_of(const std::string& config, const std::vector<std::string>& settings) {
  OdometryConfig base;
  if (config.ends_with(".yaml") || config.ends_with(".yml")) {
    base = load_config(config);
  } else if (!config.empty()) {
    base = parse_config(config, "config");
  }
  return with_overrides(base, settings);
}

SweepResult register_sweep(Odometry& odometry, const PointArray& points, const std::optional<TimeArray>& times_s,
                           std::int64_t stamp_ns, const std::optional<RingArray>& rings) {
  SweepView sweep;
  sweep.stamp_ns = stamp_ns;
  sweep.points = points_of(points);
  const auto check = [&](py::ssize_t size, const char* name) {
    if (static_cast<std::size_t>(size) != sweep.points.size()) {
      throw py::value_error(std::string(name) + ": " + std::to_string(size) + " values for " +
                            std::to_string(sweep.points.size()) + " points");
    }
  };
  if (times_s) {
    check(times_s->size(), "times_s");
    sweep.times_s = {times_s->data(), static_cast<std::size_t>(times_s->size())};
  }
  if (rings) {
    check(rings->size(), "rings");
    sweep.rings = {rings->data(), static_cast<std::size_t>(rings->size())};
  }
  const py::gil_scoped_release others_go_on;
  return odometry.register_sweep(sweep);
}

}  // namespace

void add_odometry(py::module_& module) {
  py::class_<SweepResult>(module, "SweepResult", "What the odometry says of one sweep.")
      .def_readonly("stamp_ns", &SweepResult::stamp_ns, "Instant of the pose.")
      .def_property_readonly(
          "pose", [](const SweepResult& r) { return pose_array(r.T_odom_lidar); }, "T_odom_lidar, (4, 4).")
      .def_readonly("twist", &SweepResult::twist, "Velocity during the sweep, sensor frame [rad/s; m/s].")
      .def_readonly("covariance", &SweepResult::covariance,
                    "Of the pose given the one before, (6, 6), sensor frame [rad; m].")
      .def_property_readonly(
          "status", [](const SweepResult& r) { return std::string(to_string(r.status)); },
          "initialising, ok, degenerate, few_correspondences, lost, recovered or empty.")
      .def_property_readonly("inlier_ratio", [](const SweepResult& r) { return r.stats.inlier_ratio; })
      .def_property_readonly("sigma_th_m", [](const SweepResult& r) { return r.stats.sigma_th_m; })
      .def_property_readonly("iterations", [](const SweepResult& r) { return r.stats.iterations; })
      .def_property_readonly("elevation_offset_rad", [](const SweepResult& r) { return r.stats.elevation_offset_rad; })
      .def_property_readonly("relative_eigenvalues", [](const SweepResult& r) { return r.stats.relative_eigenvalues; })
      .def_property_readonly("total_ms", [](const SweepResult& r) { return r.stats.times.total_ms; })
      .def("__repr__", [](const SweepResult& r) {
        return "<rilo.SweepResult " + std::string(to_string(r.status)) + " at " + std::to_string(r.stamp_ns) + " ns>";
      });

  py::class_<Odometry>(module, "Odometry", "One call of register() per sweep. One thread uses it.")
      .def(py::init([](const std::string& config, const std::vector<std::string>& settings) {
             return Odometry(config_of(config, settings), monotonic_ns);
           }),
           py::arg("config") = "", py::arg("settings") = std::vector<std::string>{},
           "config: YAML text, or the path of a .yaml file; settings: \"key=value\" on top of it.")
      .def("register", &register_sweep, py::arg("points"), py::arg("times_s") = py::none(), py::arg("stamp_ns") = 0,
           py::arg("rings") = py::none(),
           "Registers points (N, 3) with times (N,) in s from stamp_ns. float32 arrays are used in place.")
      .def_property_readonly(
          "trajectory",
          [](const Odometry& odometry) {
            std::vector<SE3> poses;
            for (const StampedPose& pose : odometry.trajectory()) poses.push_back(pose.T_odom_lidar);
            return pose_array(poses);
          },
          "Poses so far, (N, 4, 4).")
      .def_property_readonly(
          "stamps_ns",
          [](const Odometry& odometry) {
            std::vector<std::int64_t> stamps;
            for (const StampedPose& pose : odometry.trajectory()) stamps.push_back(pose.stamp_ns);
            const auto count = static_cast<py::ssize_t>(stamps.size());
            return hand_over<std::int64_t>(std::move(stamps), {count});
          },
          "Their instants, (N,).")
      .def(
          "local_map", [](const Odometry& odometry) { return point_array(odometry.local_map()); },
          "Points of the local map, odometry frame, (N, 3).")
      .def("reset", &Odometry::reset, "Forgets everything.");

  module.def(
      "dump_config",
      [](const std::string& config, const std::vector<std::string>& settings) {
        return dump_config(config_of(config, settings));
      },
      py::arg("config") = "", py::arg("settings") = std::vector<std::string>{},
      "All keys as YAML, with their meaning.");
}

}  // namespace rilo::python
