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

/// A column of numbers: in the array's own memory where that has our type and no holes, else a converted copy.
template <typename Value>
struct Column {
  py::array array;            ///< keeps the memory alive
  std::vector<Value> copied;  ///< empty: the array is used in place
  std::span<const Value> values;
};

/// The points of an (N, 3) or (N, 4) array of float32 or float64; the fourth column is ignored.
/// (N, 3) float32 in C order is used in place. @throws ValueError saying what came instead.
Column<Eigen::Vector3f> points_of(const py::object& object);

/// Seconds, (N,) float32 or float64 for `points` points. @throws ValueError saying what came instead.
Column<float> times_of(const py::object& object, std::size_t points);

/// Beam indices, (N,) of any integer type, 0 … 65535. @throws ValueError saying what came instead.
Column<std::uint16_t> rings_of(const py::object& object, std::size_t points);

/// Any integers as int64. @throws ValueError for one that is none.
std::vector<std::int64_t> integers_of(const py::array& array, const std::string& name);

/// (N,) int64. @throws ValueError saying what came instead.
std::vector<std::int64_t> stamps_of(const py::object& object, std::size_t poses);

/// The poses of an (N, 4, 4) or (N, 3, 4) array. @throws ValueError saying what came instead: another shape, a pose
/// that is not finite, or one that is not a rigid transform.
std::vector<SE3> poses_of(const py::object& object, const char* name);

/// @throws TypeError "name: got 1.5 of type float; expected …".
[[noreturn]] void refuse_type(const std::string& name, const py::handle& value, const std::string& expected);

/// "shape (3, 100), int64", or the type of what is not an array.
std::string description_of(const py::handle& object);

/// `object` as numpy sees it, without a copy where it is an array. @throws ValueError when numpy makes none of it, and
/// for masked elements.
py::array array_of(const py::object& object, const char* name);

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
