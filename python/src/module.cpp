#include <exception>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/config/config_error.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::python {

std::span<const Eigen::Vector3f> points_of(const PointArray& array) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw py::value_error("points: expected an array of shape (N, 3)");
  }
  return {reinterpret_cast<const Eigen::Vector3f*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

std::vector<SE3> poses_of(const PoseArray& array) {
  if (array.ndim() != 3 || (array.shape(1) != 4 && array.shape(1) != 3) || array.shape(2) != 4) {
    throw py::value_error("poses: expected an array of shape (N, 4, 4) or (N, 3, 4)");
  }
  const auto values = array.unchecked<3>();
  std::vector<SE3> poses(static_cast<std::size_t>(array.shape(0)), SE3::Identity());
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    for (py::ssize_t row = 0; row < 3; ++row) {
      for (py::ssize_t column = 0; column < 4; ++column) {
        poses[static_cast<std::size_t>(i)](row, column) = values(i, row, column);
      }
    }
  }
  return poses;
}

py::array_t<double> pose_array(const std::vector<SE3>& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  auto values = array.mutable_unchecked<3>();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix4d matrix = poses[i].matrix();
    for (Eigen::Index row = 0; row < 4; ++row) {
      for (Eigen::Index column = 0; column < 4; ++column) {
        values(static_cast<py::ssize_t>(i), row, column) = matrix(row, column);
      }
    }
  }
  return array;
}

py::array_t<double> pose_array(const SE3& pose) { return pose_array(std::vector<SE3>{pose}).attr("reshape")(4, 4); }

}  // namespace rilo::python

PYBIND11_MODULE(_rilo, module) {
  using namespace rilo::python;
  module.doc() = "LiDAR-only odometry. Metres, radians, int64 nanoseconds; T_a_b maps b to a.";
  // The last one is asked first: a ConfigError is an IoError, too.
  py::register_exception<rilo::IoError>(module, "IoError", PyExc_OSError);
  py::register_exception<rilo::ConfigError>(module, "ConfigError", PyExc_ValueError);
  add_odometry(module);
  add_sources(module);
  add_evaluation(module);
  add_simulation(module);
}
