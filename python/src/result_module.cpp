// The result of one sweep.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "modules.hpp"
#include "notebook.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo::python {

namespace {

double seconds_of(const SweepResult& r) { return static_cast<double>(r.stamp_ns) * 1e-9; }

std::string result_repr(const SweepResult& r) {
  return "<rilo.SweepResult " + std::string(to_string(r.status)) + " at " + text_of("%.3f", seconds_of(r)) +
         " s, position " + position_text(r.T_odom_lidar.translation()) +
         text_of(", %zu correspondences>", r.stats.inliers);
}

py::str result_html(const SweepResult& r) {
  const SE3& pose = r.T_odom_lidar;
  const Eigen::Vector3d sigma = r.covariance.diagonal().tail<3>().cwiseMax(0).cwiseSqrt();
  return html_table("rilo.SweepResult: " + std::string(to_string(r.status)),
                    {{"pose time", text_of("%.9f s", seconds_of(r))},
                     {"position", position_text(pose.translation())},
                     {"standard deviation since the sweep before", position_text(sigma)},
                     {"velocity (sensor frame)", text_of("%.2f m/s, %.1f deg/s", r.twist.tail<3>().norm(),
                                                         r.twist.head<3>().norm() * 57.29577951308232)},
                     {"correspondences", text_of("%zu for %zu points", r.stats.inliers, r.stats.points_source)},
                     {"iterations", std::to_string(r.stats.iterations)},
                     {"time", text_of("%.1f ms", r.stats.times.total_ms)}});
}

void add_statistics(py::class_<SweepResult>& result) {
  result
      .def_property_readonly(
          "inlier_ratio", [](const SweepResult& r) { return r.stats.inlier_ratio; },
          "Correspondences per source point: small where the sweep finds little of the map, above 1 where many points "
          "lie on no plane, which count along up to three axes.")
      .def_property_readonly(
          "residual_rms_m", [](const SweepResult& r) { return r.stats.residual_rms_m; },
          "Weighted point-to-plane residual, m.")
      .def_property_readonly(
          "sigma_th_m", [](const SweepResult& r) { return r.stats.sigma_th_m; },
          "Scale of the weights (adaptive threshold) that this sweep was registered with, m.")
      .def_property_readonly(
          "iterations", [](const SweepResult& r) { return r.stats.iterations; }, "Iterations of the fine registration.")
      .def_property_readonly(
          "converged", [](const SweepResult& r) { return r.stats.converged; },
          "Whether the fine registration converged.")
      .def_property_readonly(
          "points_in", [](const SweepResult& r) { return r.stats.points_in; }, "Number of points as given.")
      .def_property_readonly(
          "points_source", [](const SweepResult& r) { return r.stats.points_source; },
          "Points that were registered, after range limits and downsampling.")
      .def_property_readonly(
          "initial_pose", [](const SweepResult& r) { return std::string(to_string(r.stats.initial_pose)); },
          "What started the fine registration: identity, prediction or coarse.")
      .def_property_readonly(
          "loss_cause", [](const SweepResult& r) { return std::string(to_string(r.stats.loss_cause)); },
          "Why the sweep is lost, also when a map begins with it; none: it is not. The words: docs/command.md.")
      .def_property_readonly(
          "elevation_offset_rad", [](const SweepResult& r) { return r.stats.elevation_offset_rad; },
          "Estimate of the angle that the sensor's elevation angles lack, rad.")
      .def_property_readonly(
          "relative_eigenvalues", [](const SweepResult& r) { return r.stats.relative_eigenvalues; },
          "Eigenvalues of the information matrix, ascending, the largest = 1; a small first one: a direction is hardly "
          "observable.")
      .def_property_readonly(
          "total_ms", [](const SweepResult& r) { return r.stats.times.total_ms; }, "Wall time of the sweep, ms.");
}

}  // namespace

void add_results(py::module_& module) {
  py::class_<SweepResult> result(module, "SweepResult",
                                 "Result of one sweep: pose, velocity, covariance, status, statistics.");
  result.def_readonly("stamp_ns", &SweepResult::stamp_ns, "Time that the pose refers to, ns.")
      .def_property_readonly(
          "pose", [](const SweepResult& r) { return pose_array(r.T_odom_lidar); },
          "T_odom_lidar, (4, 4) float64: maps points of the sensor frame to the odometry frame (m).")
      .def_property_readonly(
          "position", [](const SweepResult& r) { return Eigen::Vector3d(r.T_odom_lidar.translation()); },
          "Translation of the pose, (3,) float64, m.")
      .def_readonly("twist", &SweepResult::twist,
                    "Velocity at the time of the pose, sensor frame: (6,), angular [rad/s], then linear [m/s].")
      .def_readonly("acceleration", &SweepResult::acceleration,
                    "Change of that velocity during the sweep, sensor frame: (6,), angular [rad/s2], then linear "
                    "[m/s2]. 0 where it is not known.")
      .def_readonly(
          "covariance", &SweepResult::covariance,
          "Covariance of the pose given the one before, (6, 6), sensor frame: rotation [rad], then translation "
          "[m], right perturbation.")
      .def_property_readonly(
          "status", [](const SweepResult& r) { return std::string(to_string(r.status)); },
          "initialising, ok, degenerate, lost, recovered or empty: how far the pose can be "
          "trusted.")
      .def("__copy__", [](const SweepResult& r) { return r; })
      .def("__deepcopy__", [](const SweepResult& r, const py::dict& /*memo*/) { return r; })
      .def("__repr__", result_repr)
      .def("_repr_html_", result_html);
  add_statistics(result);
}

}  // namespace rilo::python
