// Trajectories and maps to and from files.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/io/map_writer.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::python {

namespace {

Trajectory stamped(const std::vector<SE3>& poses, const py::object& stamps_ns) {
  const std::vector<std::int64_t> stamps = stamps_of(stamps_ns, poses.size());
  Trajectory trajectory;
  for (std::size_t i = 0; i < poses.size(); ++i) trajectory.push_back({stamps[i], poses[i]});
  return trajectory;
}

void write_poses(const std::filesystem::path& path, const py::object& poses, const py::object& stamps_ns,
                 const std::string& format) {
  const std::vector<SE3> taken = poses_of(poses, "poses");
  if (format == "kitti") return write_kitti_poses(path, taken);
  if (format != "tum" && format != "euroc") {
    throw py::value_error("format: got '" + format + "'; expected tum, kitti or euroc");
  }
  if (stamps_ns.is_none()) throw py::value_error("stamps_ns: needed for format " + format + "; kitti has none");
  format == "tum" ? write_tum(path, stamped(taken, stamps_ns)) : write_euroc(path, stamped(taken, stamps_ns));
}

py::object read_poses(const std::filesystem::path& path, const std::string& format) {
  if (format == "kitti") return pose_array(read_kitti_poses(path));
  if (format != "tum" && format != "euroc") {
    throw py::value_error("format: got '" + format + "'; expected tum, kitti or euroc");
  }
  std::vector<std::int64_t> stamps;
  std::vector<SE3> poses;
  for (const StampedPose& pose : format == "tum" ? read_tum(path) : read_euroc(path)) {
    stamps.push_back(pose.stamp_ns);
    poses.push_back(pose.T_odom_lidar);
  }
  const auto count = static_cast<py::ssize_t>(stamps.size());
  return py::make_tuple(hand_over<std::int64_t>(std::move(stamps), {count}), pose_array(poses));
}

}  // namespace

void add_files(py::module_& module) {
  module.def("write_poses", write_poses, py::arg("path"), py::arg("poses"), py::arg("stamps_ns") = py::none(),
             py::arg("format") = "tum",
             "Writes poses (N, 4, 4) as tum or euroc (with stamps_ns, (N,) int64) or kitti. Raises IoError.");
  module.def("read_poses", read_poses, py::arg("path"), py::arg("format") = "tum",
             "Reads (stamps_ns, poses) of a tum or euroc file, or the poses (N, 4, 4) of a kitti file. Raises IoError "
             "with line "
             "and column.");
  module.def(
      "write_map",
      [](const std::filesystem::path& path, const py::object& points) {
        const auto taken = points_of(points);
        MapCloud map;
        map.points.assign(taken.values.begin(), taken.values.end());
        write_map(path, map);
      },
      py::arg("path"), py::arg("points"), "Writes points (N, 3), m, as .ply or .pcd (binary). Raises IoError.");
}

}  // namespace rilo::python
