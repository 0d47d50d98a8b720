// Sweeps from files and recordings.
#include <filesystem>
#include <memory>
#include <mutex>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>
#include <unistd.h>

#include "arrays.hpp"
#include "held.hpp"
#include "modules.hpp"
#include "notebook.hpp"
#include "rilo/io/scan_source.hpp"
#include "sources.hpp"

namespace rilo::python {

namespace {

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

/// The value of a word. @throws ValueError with the words that there are.
template <typename Parse>
auto choice(const char* name, const std::string& text, const Parse& parse, const char* expected) {
  const auto value = parse(text);
  if (!value) throw py::value_error(std::string(name) + ": got '" + text + "'; expected " + expected);
  return *value;
}

/// As rilo.open() has them; the names are those of the command's options.
SourceOptions options_of(const std::string& topic, const std::filesystem::path& sensor_file,
                         const std::string& bin_fields, const std::string& point_times,
                         const std::string& point_time_unit, const std::string& point_time_reference,
                         const std::string& time_field, const std::string& spin, double elevation_correction_deg,
                         std::optional<double> rate, int parts, bool skip_bad_sweeps) {
  SourceOptions options;
  options.topic = topic;
  options.sensor_file = sensor_file.string();
  if (!bin_fields.empty()) options.bin_fields = bin_fields;
  options.point_times = choice("point_times", point_times, parse_point_times, "auto, none, azimuth or order");
  options.point_time_unit =
      choice("point_time_unit", point_time_unit, parse_point_time_unit, "infer, s, ms, us, ns or fraction");
  options.point_time_reference =
      choice("point_time_reference", point_time_reference, parse_point_time_reference, "infer, stamp or epoch");
  options.time_field = time_field;
  options.spin_direction = choice("spin", spin, parse_spin_direction, "clockwise or counter-clockwise");
  options.elevation_correction_deg = elevation_correction_deg;
  options.rate_hz = rate;
  options.parts = parts;
  options.on_bad_sweep = skip_bad_sweeps ? OnBadSweep::kSkip : OnBadSweep::kFail;
  return options;
}

/// Open data, until they are closed. Any thread may call it, of the process that opened them: a fork leaves the thread
/// that reads ahead behind, and whoever waited for it would wait for ever.
class PythonSource {
 public:
  explicit PythonSource(std::unique_ptr<ScanSource> source) : source_(std::move(source)) {}
  ~PythonSource() {
    if (is_forked()) static_cast<void>(source_.release());
  }
  PythonSource(const PythonSource&) = delete;
  PythonSource& operator=(const PythonSource&) = delete;

  /// What `function` makes of the data, without Python's lock. @throws ValueError when they are closed.
  template <typename Function>
  auto with(const Function& function) const {
    if (is_forked()) throw py::value_error("the ScanSource is another process's; open the data in this one");
    const Held held(mutex_);
    if (!source_) throw py::value_error("the ScanSource is closed");
    return function(*source_);
  }

  SourceInfo info() const {
    return with([](const ScanSource& source) { return source.info(); });
  }
  std::optional<std::size_t> size() const {
    return with([](const ScanSource& source) { return source.size(); });
  }
  bool closed() const {
    if (is_forked()) return true;
    const Held held(mutex_);
    return source_ == nullptr;
  }
  void close() {
    if (is_forked()) return;
    const Held held(mutex_);
    source_.reset();
  }

 private:
  bool is_forked() const { return getpid() != process_; }

  pid_t process_ = getpid();
  mutable std::mutex mutex_;
  std::unique_ptr<ScanSource> source_;
};

SharedSweep next_of(const PythonSource& source) {
  auto sweep = source.with([](ScanSource& open) { return open.next(); });
  if (!sweep) throw py::stop_iteration();
  return SharedSweep{std::make_shared<Sweep>(std::move(*sweep))};
}

HtmlRows rows_of(const PythonSource& source) {
  const SourceInfo info = source.info();
  const auto size = source.size();
  HtmlRows rows{
      {"path", info.path.string()},
      {"kind", info.kind + ", " + info.format},
      {"sweeps", size ? std::to_string(*size) : "known when they were read"},
      {"period", text_of("%.4g s", info.period_s) + (info.stamps_assumed ? ", assumed: no stamps in the data" : "")},
      {"point times", info.point_times}};
  if (!info.topic.empty()) rows.emplace_back("topic", info.topic);
  for (const std::string& warning : info.warnings) rows.emplace_back("warning", warning);
  return rows;
}

py::str source_repr(const PythonSource& source) {
  if (source.closed()) return py::str("<rilo.ScanSource, closed>");
  const SourceInfo info = source.info();
  const auto size = source.size();
  return python_text("<rilo.ScanSource " + info.path.string() + ": " + info.kind + ", " + info.format + ", " +
                     (size ? std::to_string(*size) + " sweeps" : "number of sweeps not known yet") + ">");
}

std::string sweep_repr(const SharedSweep& s) {
  const auto has = [](bool given, const char* name) { return given ? std::string(", ") + name : std::string(); };
  return "<rilo.Sweep of " + std::to_string(s.sweep->points.size()) + " points at " +
         text_of("%.3f", static_cast<double>(s.sweep->stamp_ns) * 1e-9) + " s" +
         has(!s.sweep->times_s.empty(), "times") + has(!s.sweep->intensities.empty(), "intensities") +
         has(!s.sweep->rings.empty(), "rings") + ">";
}

}  // namespace

void add_sources(py::module_& module) {
  py::class_<SharedSweep>(module, "Sweep", "Points of one sweep, sensor frame. The arrays look into its memory.")
      .def_property_readonly(
          "stamp_ns", [](const SharedSweep& s) { return s.sweep->stamp_ns; }, "Time that times_s count from, ns.")
      .def_property_readonly(
          "points",
          [](const SharedSweep& s) {
            const auto count = static_cast<py::ssize_t>(s.sweep->points.size());
            return column<float>(s, s.sweep->points, {count, 3});
          },
          "(N, 3) float32, m.")
      .def_property_readonly(
          "times_s", [](const SharedSweep& s) { return column(s, s.sweep->times_s); },
          "(N,) float32, s from the stamp; None: no times, or already motion-compensated.")
      .def_property_readonly(
          "intensities", [](const SharedSweep& s) { return column(s, s.sweep->intensities); },
          "(N,) float32, sensor units; None without.")
      .def_property_readonly(
          "rings", [](const SharedSweep& s) { return column(s, s.sweep->rings); },
          "(N,) uint16, beam index; None without.")
      .def("__len__", [](const SharedSweep& s) { return s.sweep->points.size(); })
      .def("__repr__", [](const SharedSweep& s) { return sweep_repr(s); });

  py::class_<PythonSource>(
      module, "ScanSource",
      "Iterates over the sweeps of a folder, file or recording, once. len() gives their number where it is "
      "known without reading them (else TypeError, so that list() and tqdm do without). May stand in a with statement.")
      .def(
          "__iter__", [](PythonSource& source) -> PythonSource& { return source; }, py::return_value_policy::reference)
      .def("__next__", next_of)
      .def("__len__",
           [](const PythonSource& source) {
             if (const auto size = source.size()) return *size;
             throw py::type_error("the number of sweeps is not known before they are read");
           })
      .def(
          "__enter__", [](PythonSource& source) -> PythonSource& { return source; }, py::return_value_policy::reference)
      .def("__exit__", [](PythonSource& source, const py::args& /*exception*/) { source.close(); })
      .def("close", &PythonSource::close,
           "Lets go of files and read-ahead; sweeps that were read stay. What is asked for later raises ValueError.")
      .def(
          "skip",
          [](const PythonSource& source, std::size_t count) {
            return source.with([count](ScanSource& open) { return open.skip(count); });
          },
          py::arg("count"), "Skips up to `count` sweeps without reading them; returns how many there were.")
      .def_property_readonly(
          "kind", [](const PythonSource& source) { return source.info().kind; },
          "kitti, folder, file, recording, packets, ...")
      .def_property_readonly(
          "format", [](const PythonSource& source) { return source.info().format; },
          "bin, pcd, ply, mcap, ROS 1 bag, ...")
      .def_property_readonly(
          "period_s", [](const PythonSource& source) { return source.info().period_s; },
          "Mean step of the stamps, s, without those that differ by half from their median; 1 / rate without stamps.")
      .def_property_readonly(
          "point_times", [](const PythonSource& source) { return source.info().point_times; },
          "Where the per-point times come from, with unit and reference; known after the first sweep.")
      .def_property_readonly(
          "topic", [](const PythonSource& source) { return source.info().topic; }, "Topic of a recording.")
      .def_property_readonly(
          "frame_id", [](const PythonSource& source) { return source.info().frame_id; }, "Frame of its messages.")
      .def_property_readonly(
          "warnings", [](const PythonSource& source) { return source.info().warnings; },
          "Sentences for the user about what was found in the data so far.")
      .def("__repr__", source_repr)
      .def("_repr_html_", [](const PythonSource& source) { return html_table("rilo.ScanSource", rows_of(source)); });

  // Python's open() and run() take these as keywords: rilo/_sources.py.
  py::class_<SourceOptions>(module, "_SourceOptions")
      .def(py::init(&options_of), py::kw_only(), py::arg("topic"), py::arg("sensor_file"), py::arg("bin_fields"),
           py::arg("point_times"), py::arg("point_time_unit"), py::arg("point_time_reference"), py::arg("time_field"),
           py::arg("spin"), py::arg("elevation_correction_deg"), py::arg("rate"), py::arg("parts"),
           py::arg("skip_bad_sweeps"));
  module.def(
      "_open",
      [](const std::filesystem::path& path, const SourceOptions& options) {
        return std::make_unique<PythonSource>(open_scan_source(path, options));
      },
      py::arg("path"), py::arg("options"), py::call_guard<py::gil_scoped_release>());
}

}  // namespace rilo::python
