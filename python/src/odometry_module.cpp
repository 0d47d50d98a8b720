// Odometry and its configuration.
#include <pybind11/stl.h>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "modules.hpp"
#include "notebook.hpp"
#include "python_odometry.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/config/config_file.hpp"
#include "settings.hpp"

namespace rilo::python {

namespace {

py::array_t<double> trajectory_of(const PythonOdometry& self) {
  return pose_array(self.read([](const Odometry& odometry) {
    std::vector<SE3> poses;
    for (const StampedPose& pose : odometry.trajectory()) poses.push_back(pose.T_odom_lidar);
    return poses;
  }));
}

py::array_t<std::int64_t> trajectory_stamps(const PythonOdometry& self) {
  auto stamps = self.read([](const Odometry& odometry) {
    std::vector<std::int64_t> all;
    for (const StampedPose& pose : odometry.trajectory()) all.push_back(pose.stamp_ns);
    return all;
  });
  const auto count = static_cast<py::ssize_t>(stamps.size());
  return hand_over<std::int64_t>(std::move(stamps), {count});
}

std::size_t sweeps_of(const PythonOdometry& self) {
  return self.read([](const Odometry& odometry) { return odometry.trajectory().size(); });
}

SE3 last_pose_of(const PythonOdometry& self) {
  return self.read([](const Odometry& odometry) {
    const Trajectory& poses = odometry.trajectory();
    return poses.empty() ? SE3::Identity() : poses.back().T_odom_lidar;
  });
}

std::string odometry_repr(const PythonOdometry& self) {
  return text_of("<rilo.Odometry after %zu sweeps, position ", sweeps_of(self)) +
         position_text(last_pose_of(self).translation()) + ">";
}

py::str odometry_html(const PythonOdometry& self) {
  const double path_m = self.read([](const Odometry& odometry) {
    const Trajectory& poses = odometry.trajectory();
    double length = 0;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      length += (poses[i].T_odom_lidar.translation() - poses[i - 1].T_odom_lidar.translation()).norm();
    }
    return length;
  });
  return html_table("rilo.Odometry", {{"sweeps", std::to_string(sweeps_of(self))},
                                      {"path", text_of("%.1f m", path_m)},
                                      {"position", position_text(last_pose_of(self).translation())}});
}

constexpr const char* kOdometryDoc = R"(LiDAR odometry: one call of register() or register_frame() per sweep.

config:   the configuration as a dict, YAML text, or the path of a .yaml file; default: the built-in values.
settings: single keys on top of it, as a dict ({"map": {"voxel_m": 0.3}} or {"map.voxel_m": 0.3}) or as a list of
          "key=value". rilo.dump_config() lists all keys with unit, range and meaning.
calibration: angles of this sensor, learnt in another run: the path of its calibration.yaml or the text of
          Odometry.calibration(). Of another sensor they are a ValueError at the first sweep.

Raises ConfigError for an unknown key or a value out of range. Threads that call the same one wait for each other.)";

constexpr const char* kRegisterDoc = R"(Registers one sweep and returns its SweepResult.

points:   (N, 3) or (N, 4), float32 or float64, m, sensor frame (x forward, y left, z up); a fourth column (intensity)
          is ignored. (N, 3) float32 in C order is used in place, anything else is copied. NaN points are dropped.
times_s:  (N,) float32 or float64, s from stamp_ns (at most 2.5), for motion compensation. None: none, or compensated
          already.
stamp_ns: time that times_s count from, ns. None: 0.1 s after the sweep before.
rings:    (N,) integers, beam index; needed for the calibration of single beams only.

Raises ValueError for arrays of another shape or type and for times that are no seconds of a sweep, TypeError for a
stamp that is no integer. Bad points are not an error: see SweepResult.status.)";

constexpr const char* kRegisterFrameDoc = R"(Registers one sweep whose timestamps are as the driver gives them.

points:          as for register().
timestamps:      (N,) numbers, one per point, from the start of the sweep or of a clock (then the earliest is the stamp
                 of the sweep). None: no motion compensation.
stamp_ns:        stamp of the sweep, ns. None: from a clock's timestamps, else 0.1 s after the sweep before.
point_time_unit: infer (from the span of the first sweep), s, ms, us, ns, or fraction (0 to 1 of a sweep of 0.1 s).

Returns a SweepResult. Raises ValueError for arrays of another shape or type, IoError for timestamps whose unit cannot
be told.)";

}  // namespace

void add_odometry(py::module_& module) {
  py::class_<PythonOdometry>(module, "Odometry", kOdometryDoc)
      .def(py::init<const py::object&, const py::object&, const py::object&>(), py::arg("config") = py::none(),
           py::arg("settings") = py::none(), py::arg("calibration") = py::none())
      .def("register", &PythonOdometry::register_sweep, py::arg("points"), py::arg("times_s") = py::none(),
           py::arg("stamp_ns") = py::none(), py::arg("rings") = py::none(), kRegisterDoc)
      .def("register_frame", &PythonOdometry::register_frame, py::arg("points"), py::arg("timestamps") = py::none(),
           py::arg("stamp_ns") = py::none(), py::arg("point_time_unit") = "infer", kRegisterFrameDoc)
      .def_property_readonly("trajectory", trajectory_of, "Poses T_odom_lidar so far, (N, 4, 4) float64.")
      .def_property_readonly("stamps_ns", trajectory_stamps, "Times that the poses refer to, (N,) int64, ns.")
      .def_property_readonly(
          "last_pose", [](const PythonOdometry& self) { return pose_array(last_pose_of(self)); },
          "Pose of the last sweep, (4, 4) float64; the identity before the first.")
      .def(
          "local_map",
          [](const PythonOdometry& self) {
            return point_array(self.read([](const Odometry& odometry) { return odometry.local_map(); }));
          },
          "Points of the local map, odometry frame, (M, 3) float32, m.")
      .def(
          "last_map_points",
          [](const PythonOdometry& self) {
            return point_array(self.read(
                [](const Odometry& odometry) { return std::vector<Eigen::Vector3f>(odometry.last_map_points()); }));
          },
          "Points of the last sweep that went into the map, motion-compensated, sensor frame at the pose's time, "
          "(M, 3) float32, m.")
      .def(
          "config", [](const PythonOdometry& self) { return dump_config(self.config()); },
          "The configuration in use, YAML with all keys.")
      .def(
          "calibration",
          [](const PythonOdometry& self) {
            const auto [angles, sweeps] = self.read([](const Odometry& odometry) {
              return std::pair(odometry.sensor_angles(), odometry.trajectory().size());
            });
            return dump_calibration(angles, text_of("%zu sweeps", sweeps));
          },
          "What is known about the sensor's angles by now, YAML: to be written to a file, or for calibration=.")
      .def("reset", &PythonOdometry::reset, "Clears map and trajectory; the next sweep starts at the identity.")
      .def("start_over", &PythonOdometry::start_over,
           "As reset(), but what was learnt about the sensor stays: the angles of its beams and, if it is certain, its "
           "elevation offset (returned, rad). For a second pass over the same sweeps.")
      .def("__len__", sweeps_of)
      .def("__repr__", odometry_repr)
      .def("_repr_html_", odometry_html);

  module.def(
      "dump_config",
      [](const py::object& config, const py::object& settings) { return dump_config(config_of(config, settings)); },
      py::arg("config") = py::none(), py::arg("settings") = py::none(),
      "All keys as YAML, with unit, range and meaning; arguments as for Odometry.");
}

}  // namespace rilo::python
