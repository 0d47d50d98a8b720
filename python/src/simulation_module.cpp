// The drive simulator.
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/simulation/drive_simulator.hpp"

namespace rilo::python {

namespace {

constexpr const char* kSimulatorDoc = R"(A drive through a small town; the same arguments give the same bytes.

sensor:   hdl64, vlp16 or os1-64.
sweeps:   number of sweeps, 10 per second; 0: one lap and a little more.
seed:     town, traffic and noise.
start_s:  begin this far into the drive, s; 0: standing.
deskewed: points compensated to the middle of the sweep, without times; else each at its own time.)";

py::tuple sweep_of(const DriveSimulator& simulator, py::ssize_t index) {
  const auto i = static_cast<std::size_t>(index);
  if (index < 0 || i >= simulator.size()) {
    throw py::index_error("sweep " + std::to_string(index) + " of " + std::to_string(simulator.size()));
  }
  SimulatedSweep s;
  {
    const py::gil_scoped_release others_go_on;
    s = simulator.sweep(i);
  }
  const auto count = static_cast<py::ssize_t>(s.sweep.times_s.size());
  const py::object times = count > 0 ? py::object(hand_over<float>(std::move(s.sweep.times_s), {count})) : py::none();
  return py::make_tuple(point_array(std::move(s.sweep.points)), times, s.sweep.stamp_ns,
                        pose_array(s.T_odom_lidar_mid));
}

}  // namespace

void add_simulation(py::module_& module) {
  py::class_<DriveSimulator>(module, "Simulator", kSimulatorDoc)
      .def(py::init(
               [](const std::string& sensor, std::size_t sweeps, std::uint64_t seed, double start_s, bool deskewed) {
                 DriveConfig config;
                 const auto kind = parse_sensor_kind(sensor);
                 if (!kind) throw py::value_error("sensor: got '" + sensor + "'; expected hdl64, vlp16 or os1-64");
                 config.sensor = *kind;
                 config.sweeps = sweeps;
                 config.seed = seed;
                 config.start_s = start_s;
                 config.deskewed = deskewed;
                 return DriveSimulator(config);
               }),
           py::arg("sensor") = "hdl64", py::arg("sweeps") = 0, py::arg("seed") = 1, py::arg("start_s") = 0.0,
           py::arg("deskewed") = false)
      .def("__len__", &DriveSimulator::size)
      .def(
          "sweep", sweep_of, py::arg("index"),
          "Sweep number `index` as (points (N, 3) float32, times_s (N,) float32 or None, stamp_ns, true pose (4, 4) at "
          "the middle of the sweep). Raises IndexError past the last.")
      .def("__getitem__", sweep_of, py::arg("index"), "As sweep().")
      .def("__iter__",
           [](const py::object& self) { return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr())); })
      .def("__repr__", [](const DriveSimulator& simulator) {
        return "<rilo.Simulator of " + std::to_string(simulator.size()) + " sweeps>";
      });
}

}  // namespace rilo::python
