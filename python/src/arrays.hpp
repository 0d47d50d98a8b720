// numpy arrays to views and back.
#pragma once

#include <cstdint>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "rilo/geometry/se3.hpp"

namespace rilo::python {

namespace py = pybind11;

/// float32, rows together: taken as they are. Other arrays are converted (a copy) by pybind11 on the way in.
using PointArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
using TimeArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
using RingArray = py::array_t<std::uint16_t, py::array::c_style | py::array::forcecast>;
using PoseArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The points of an (N, 3) array, in place. @throws ValueError for another shape.
std::span<const Eigen::Vector3f> points_of(const PointArray& array);

/// The poses of an (N, 4, 4) or (N, 3, 4) array. @throws ValueError for another shape.
std::vector<SE3> poses_of(const PoseArray& array);

/// An (N, 4, 4) array.
py::array_t<double> pose_array(const std::vector<SE3>& poses);
/// A (4, 4) array.
py::array_t<double> pose_array(const SE3& pose);

/// Hands `values` over to numpy, as an array of `shape`, without a copy.
template <typename Scalar, typename Value>
py::array_t<Scalar> hand_over(std::vector<Value>&& values, std::vector<py::ssize_t> shape) {
  auto owned = std::make_unique<std::vector<Value>>(std::move(values));
  const auto* data = reinterpret_cast<const Scalar*>(owned->data());
  const py::capsule owner(owned.get(), [](void* pointer) { delete static_cast<std::vector<Value>*>(pointer); });
  static_cast<void>(owned.release());  // the capsule has it
  return py::array_t<Scalar>(std::move(shape), data, owner);
}

/// An (N, 3) array.
inline py::array_t<float> point_array(std::vector<Eigen::Vector3f>&& points) {
  const auto count = static_cast<py::ssize_t>(points.size());
  return hand_over<float>(std::move(points), {count, 3});
}

}  // namespace rilo::python
