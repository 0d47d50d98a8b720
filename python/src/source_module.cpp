// Sweeps from files and recordings.
#include <memory>
#include <pybind11/stl.h>
#include <string>

#include "arrays.hpp"
#include "modules.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::python {

namespace {

/// A sweep whose columns numpy looks into; they live as long as one of them is used.
struct SharedSweep {
  std::shared_ptr<Sweep> sweep;
};

template <typename Scalar, typename Value>
py::object column(const SharedSweep& shared, const std::vector<Value>& values, std::vector<py::ssize_t> shape) {
  if (values.empty() && shape.size() == 1) return py::none();
  auto* owner = new std::shared_ptr<Sweep>(shared.sweep);
  const py::capsule capsule(owner, [](void* pointer) { delete static_cast<std::shared_ptr<Sweep>*>(pointer); });
  return py::array_t<Scalar>(std::move(shape), reinterpret_cast<const Scalar*>(values.data()), capsule);
}

template <typename Scalar>
py::object column(const SharedSweep& shared, const std::vector<Scalar>& values) {
  return column<Scalar>(shared, values, {static_cast<py::ssize_t>(values.size())});
}

SourceOptions options_of(const std::string& topic, const std::string& bin_fields, const std::string& point_times,
                         double elevation_correction_deg, const std::string& sensor_file) {
  SourceOptions options;
  options.topic = topic;
  options.sensor_file = sensor_file;
  if (!bin_fields.empty()) options.bin_fields = bin_fields;
  options.elevation_correction_deg = elevation_correction_deg;
  const auto times = parse_point_times(point_times);
  if (!times) throw py::value_error("point_times: '" + point_times + "'; expected auto, none or azimuth");
  options.point_times = *times;
  return options;
}

}  // namespace

void add_sources(py::module_& module) {
  py::class_<SharedSweep>(module, "Sweep", "Points of one sweep, sensor frame.")
      .def_property_readonly("stamp_ns", [](const SharedSweep& s) { return s.sweep->stamp_ns; })
      .def_property_readonly(
          "points",
          [](const SharedSweep& s) {
            const auto count = static_cast<py::ssize_t>(s.sweep->points.size());
            return column<float>(s, s.sweep->points, {count, 3});
          },
          "(N, 3) float32, m.")
      .def_property_readonly(
          "times_s", [](const SharedSweep& s) { return column(s, s.sweep->times_s); },
          "(N,) float32, s from the stamp; None without.")
      .def_property_readonly(
          "intensities", [](const SharedSweep& s) { return column(s, s.sweep->intensities); },
          "(N,) float32; None without.")
      .def_property_readonly(
          "rings", [](const SharedSweep& s) { return column(s, s.sweep->rings); }, "(N,) uint16; None without.")
      .def("__len__", [](const SharedSweep& s) { return s.sweep->points.size(); });

  py::class_<ScanSource>(module, "ScanSource", "Iterates over the sweeps of a folder, file or recording.")
      .def(
          "__iter__", [](ScanSource& source) -> ScanSource& { return source; }, py::return_value_policy::reference)
      .def("__next__",
           [](ScanSource& source) {
             std::optional<Sweep> sweep;
             {
               const py::gil_scoped_release others_go_on;
               sweep = source.next();
             }
             if (!sweep) throw py::stop_iteration();
             return SharedSweep{std::make_shared<Sweep>(std::move(*sweep))};
           })
      .def("__len__",
           [](const ScanSource& source) {
             if (const auto size = source.size()) return *size;
             throw py::type_error("the number of sweeps is not known before they are read");
           })
      .def("skip", &ScanSource::skip, py::arg("count"), "Leaves out sweeps; returns how many there were.")
      .def_property_readonly("kind", [](const ScanSource& source) { return source.info().kind; })
      .def_property_readonly("format", [](const ScanSource& source) { return source.info().format; })
      .def_property_readonly("period_s", [](const ScanSource& source) { return source.info().period_s; })
      .def_property_readonly("warnings", [](const ScanSource& source) { return source.info().warnings; });

  module.def(
      "open",
      [](const std::string& path, const std::string& topic, const std::string& bin_fields,
         const std::string& point_times, double elevation_correction_deg, const std::string& sensor_file) {
        return open_scan_source(path,
                                options_of(topic, bin_fields, point_times, elevation_correction_deg, sensor_file));
      },
      py::arg("path"), py::arg("topic") = "", py::arg("bin_fields") = "", py::arg("point_times") = "auto",
      py::arg("elevation_correction_deg") = 0.0, py::arg("sensor_file") = "",
      "Opens data of any format that `rilo run` reads; these options mean the same there.");
}

}  // namespace rilo::python
