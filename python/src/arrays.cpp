#include "arrays.hpp"

#include <cstring>

namespace rilo::python {

namespace {

[[noreturn]] void reject(const std::string& name, const std::string& expected, const py::handle& object,
                         const std::string& remedy = "") {
  throw py::value_error(name + ": got " + description_of(object) + "; expected " + expected +
                        (remedy.empty() ? "" : ". " + remedy));
}

template <typename Scalar>
bool holds(const py::array& array) {
  return py::isinstance<py::array_t<Scalar>>(array);  // native byte order, too
}

/// Whether some elements are marked as invalid. What lies there would be taken for numbers.
bool is_masked(const py::object& object) {
  return py::hasattr(object, "filled") && py::module_::import("numpy.ma").attr("is_masked")(object).cast<bool>();
}

/// Element (row, column) in any numpy layout; column 0 of a flat array.
template <typename Scalar>
Scalar element(const py::array& array, py::ssize_t row, py::ssize_t column) {
  const auto* bytes = static_cast<const char*>(array.data()) + row * array.strides(0);
  if (array.ndim() > 1) bytes += column * array.strides(1);
  Scalar value{};
  std::memcpy(&value, bytes, sizeof(Scalar));
  return value;
}

template <typename Scalar>
std::vector<Eigen::Vector3f> copied_points(const py::array& array) {
  std::vector<Eigen::Vector3f> points(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t row = 0; row < array.shape(0); ++row) {
    for (py::ssize_t axis = 0; axis < 3; ++axis) {
      points[static_cast<std::size_t>(row)][axis] = static_cast<float>(element<Scalar>(array, row, axis));
    }
  }
  return points;
}

/// Whether the elements follow each other in C order, aligned: then they need no copy.
bool is_dense(const py::array& array) {
  constexpr int kNeeded =
      static_cast<int>(py::array::c_style) | static_cast<int>(py::detail::npy_api::NPY_ARRAY_ALIGNED_);
  return (array.flags() & kNeeded) == kNeeded;
}

py::array flat_array(const py::object& object, const char* name, std::size_t points, const std::string& expected) {
  py::array array = array_of(object, name);
  if (array.ndim() != 1) reject(name, "shape (N,), " + expected, array);
  if (static_cast<std::size_t>(array.shape(0)) != points) {
    throw py::value_error(std::string(name) + ": " + std::to_string(array.shape(0)) + " values for " +
                          std::to_string(points) + " points");
  }
  return array;
}

template <typename Value>
Column<Value> column_in_place(py::array array) {
  Column<Value> column{std::move(array), {}, {}};
  column.values = {reinterpret_cast<const Value*>(column.array.data()),
                   static_cast<std::size_t>(column.array.shape(0))};
  return column;
}

template <typename Value>
Column<Value> column_of(py::array array, std::vector<Value>&& values) {
  Column<Value> column{std::move(array), std::move(values), {}};
  column.values = column.copied;
  return column;
}

// The readers' tolerance: files and float32 have 7 digits.
constexpr double kRigidTolerance = 1e-3;

const char* fault_of(const SE3& pose) {
  if (!pose.matrix().allFinite()) return "is not finite";
  const Eigen::Matrix3d R = pose.linear();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return off > kRigidTolerance || R.determinant() < 0 ? "is not a rigid transform" : nullptr;
}

}  // namespace

void refuse_type(const std::string& name, const py::handle& value, const std::string& expected) {
  throw py::type_error(name + ": got " + py::repr(value).cast<std::string>() + " of type " +
                       py::str(py::type::of(value).attr("__name__")).cast<std::string>() + "; expected " + expected);
}

std::string description_of(const py::handle& object) {
  if (!py::isinstance<py::array>(object))
    return "an object of type " + py::str(py::type::of(object).attr("__name__")).cast<std::string>();
  const py::object dtype = object.attr("dtype");
  return "shape " + py::str(object.attr("shape")).cast<std::string>() + ", " + py::str(dtype).cast<std::string>();
}

std::vector<std::int64_t> integers_of(const py::array& array, const std::string& name) {
  const auto numbers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
  std::vector<std::int64_t> integers(numbers.data(), numbers.data() + numbers.size());
  const bool may_wrap = array.dtype().kind() == 'u' && array.itemsize() == sizeof(std::uint64_t);
  for (std::size_t i = 0; may_wrap && i < integers.size(); ++i) {
    if (integers[i] >= 0) continue;
    throw py::value_error(name + ": got " + std::to_string(static_cast<std::uint64_t>(integers[i])) + " at index " +
                          std::to_string(i) + "; expected numbers below 2^63");
  }
  return integers;
}

py::array array_of(const py::object& object, const char* name) {
  try {
    py::array array(object);
    if (is_masked(object)) {
      reject(name, "no masked elements", array, "Of points without a measurement: points.filled(np.nan)");
    }
    return array;
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw;  // Ctrl-C
    reject(name, "a numpy array", object, py::str(error.value()).cast<std::string>());
  }
}

Column<Eigen::Vector3f> points_of(const py::object& object) {
  static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
  constexpr const char* kExpected = "shape (N, 3) or (N, 4), float32 or float64";
  py::array array = array_of(object, "points");
  if (!array.dtype().attr("names").is_none()) {
    reject("points", kExpected, array, "Of fields: np.stack([a[\"x\"], a[\"y\"], a[\"z\"]], axis=1)");
  }
  if (array.ndim() != 2 || (array.shape(1) != 3 && array.shape(1) != 4)) {
    const bool turned = array.ndim() == 2 && (array.shape(0) == 3 || array.shape(0) == 4);
    const bool wide = array.ndim() == 2 && array.shape(1) > 4;
    reject("points", kExpected, array, turned ? "Transpose it: points.T" : wide ? "Take points[:, :3]" : "");
  }
  if (holds<float>(array)) {
    if (array.shape(1) == 3 && is_dense(array)) return column_in_place<Eigen::Vector3f>(std::move(array));
    auto points = copied_points<float>(array);
    return column_of(std::move(array), std::move(points));
  }
  if (!holds<double>(array)) reject("points", kExpected, array, "Convert it: points.astype(np.float32)");
  auto points = copied_points<double>(array);
  return column_of(std::move(array), std::move(points));
}

Column<float> times_of(const py::object& object, std::size_t points) {
  constexpr const char* kExpected = "float32 or float64, seconds";
  py::array array = flat_array(object, "times_s", points, kExpected);
  if (holds<float>(array) && is_dense(array)) return column_in_place<float>(std::move(array));
  std::vector<float> times(points);
  const bool narrow = holds<float>(array);
  if (!narrow && !holds<double>(array)) {
    reject("times_s", kExpected, array, "Times in other units or of a clock: register_frame(points, timestamps)");
  }
  for (std::size_t i = 0; i < points; ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    times[i] = narrow ? element<float>(array, row, 0) : static_cast<float>(element<double>(array, row, 0));
  }
  return column_of(std::move(array), std::move(times));
}

Column<std::uint16_t> rings_of(const py::object& object, std::size_t points) {
  constexpr const char* kExpected = "integers from 0 to 65535";
  py::array array = flat_array(object, "rings", points, kExpected);
  if (holds<std::uint16_t>(array) && is_dense(array)) return column_in_place<std::uint16_t>(std::move(array));
  const char kind = array.dtype().kind();
  if (kind != 'i' && kind != 'u') reject("rings", kExpected, array);
  const std::vector<std::int64_t> numbers = integers_of(array, "rings");
  std::vector<std::uint16_t> rings(points);
  for (std::size_t i = 0; i < points; ++i) {
    const std::int64_t ring = numbers[i];
    if (ring < 0 || ring > 65535) {
      throw py::value_error("rings: got " + std::to_string(ring) + " at index " + std::to_string(i) + "; expected " +
                            kExpected);
    }
    rings[i] = static_cast<std::uint16_t>(ring);
  }
  return column_of(std::move(array), std::move(rings));
}

std::vector<std::int64_t> stamps_of(const py::object& object, std::size_t poses) {
  const py::array array = array_of(object, "stamps_ns");
  const char kind = array.dtype().kind();
  if (array.ndim() != 1 || static_cast<std::size_t>(array.shape(0)) != poses || (kind != 'i' && kind != 'u')) {
    reject("stamps_ns", "shape (" + std::to_string(poses) + ",), integers", array);
  }
  return integers_of(array, "stamps_ns");
}

std::vector<SE3> poses_of(const py::object& object, const char* name) {
  const py::array array = array_of(object, name);
  const char kind = array.dtype().kind();
  if (array.ndim() != 3 || (array.shape(1) != 4 && array.shape(1) != 3) || array.shape(2) != 4 ||
      (kind != 'f' && kind != 'i')) {
    reject(name, "poses of shape (N, 4, 4) or (N, 3, 4)", array);
  }
  const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>(array);
  const auto values = numbers.unchecked<3>();
  std::vector<SE3> poses(static_cast<std::size_t>(array.shape(0)), SE3::Identity());
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    for (py::ssize_t row = 0; row < 3; ++row) {
      for (py::ssize_t column = 0; column < 4; ++column) {
        poses[static_cast<std::size_t>(i)](row, column) = values(i, row, column);
      }
    }
    if (const char* fault = fault_of(poses[static_cast<std::size_t>(i)])) {
      throw py::value_error(std::string(name) + ": pose " + std::to_string(i) + " " + fault);
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
