// A whole run in one call, observed from Python.
#include <optional>
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <string>

#include "arrays.hpp"
#include "modules.hpp"
#include "notebook.hpp"
#include "rilo/config/calibration_file.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/session/session.hpp"
#include "rilo/session/session_observer.hpp"
#include "settings.hpp"
#include "sources.hpp"

namespace rilo::python {

namespace {

/// What rilo.run() gives.
struct PythonRun {
  SessionResult session;
  std::vector<std::string> warnings;
  // As Python sees them: made once.
  py::list results;
  py::array_t<float> map;
};

/// Python's callables, each None or called with Python's lock, which the run does without.
struct Callables {
  py::object on_sweep;     ///< (index, SweepResult, Sweep)
  py::object on_restart;   ///< (sweeps of the first pass, elevation offset in degrees)
  py::object on_progress;  ///< (sweeps done, sweeps to do or None)
};

class PythonObserver final : public SessionObserver {
 public:
  PythonObserver(const Callables& callables, std::vector<std::string>& warnings)
      : callables_(callables), warnings_(warnings) {}

  void set_total(std::optional<std::size_t> total) { total_ = total; }

  void on_registered(const RegisteredSweep& sweep) override {
    ++done_;
    if (!callables_.on_sweep.is_none()) {
      auto shared = std::make_shared<Sweep>(sweep.sweep);
      const py::gil_scoped_acquire lock;
      callables_.on_sweep(sweep.index, sweep.result, SharedSweep{std::move(shared)});
    }
    if (!callables_.on_progress.is_none()) {
      const py::gil_scoped_acquire lock;
      callables_.on_progress(done_, total_);
    }
  }
  void on_warning(const std::string& warning) override { warnings_.push_back(warning); }
  void on_restart(const Restart& restart) override {
    done_ = 0;
    if (callables_.on_restart.is_none()) return;
    const py::gil_scoped_acquire lock;
    callables_.on_restart(restart.after_sweeps, restart.elevation_offset_deg);
  }

 private:
  const Callables& callables_;
  std::vector<std::string>& warnings_;
  std::size_t done_ = 0;
  std::optional<std::size_t> total_;
};

/// Whether a signal (Ctrl-C) arrived; its exception is set then. Python reports a signal once, and who asked may have
/// gone on without telling.
bool signal_arrived() {
  const py::gil_scoped_acquire lock;
  return PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0;
}

PythonRun run(const std::filesystem::path& source, const SourceOptions& source_options, const py::object& config,
              const py::object& settings, const py::object& calibration, std::size_t start, std::size_t count,
              bool one_pass, std::optional<double> map_voxel_m, const py::object& on_sweep,
              const py::object& on_restart, const py::object& on_progress) {
  SessionOptions options;
  options.config = config_of(config, settings);
  options.calibration = calibration_of(calibration);
  options.start = start;
  options.count = count;
  options.one_pass = one_pass;
  options.point_times = source_options.point_times;
  options.rate_assumed = !source_options.rate_hz;
  options.interrupted = signal_arrived;
  if (map_voxel_m && !(*map_voxel_m >= ThinnedMap::kLeastVoxelM && *map_voxel_m <= ThinnedMap::kMostVoxelM)) {
    throw py::value_error(text_of("map_voxel_m: got %g; expected %g … %g m", *map_voxel_m, ThinnedMap::kLeastVoxelM,
                                  ThinnedMap::kMostVoxelM));
  }
  PythonRun done;
  const Callables callables{on_sweep, on_restart, on_progress};
  PythonObserver observer(callables, done.warnings);
  MapObserver map(map_voxel_m.value_or(1));
  {
    const py::gil_scoped_release others_go_on;
    Session session([&] { return open_scan_source(source, source_options); }, options);
    observer.set_total(sweeps_to_do(session.source(), start, count));
    session.add(observer);
    if (map_voxel_m) session.add(map);
    done.session = session.run();
  }
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (done.session.failure) std::rethrow_exception(done.session.failure);
  done.results = py::cast(done.session.results);
  done.map = point_array(map_voxel_m ? map.cloud(false).points : std::vector<Eigen::Vector3f>());
  return done;
}

double path_m(const PythonRun& run) {
  double length = 0;
  const auto& results = run.session.results;
  for (std::size_t i = 1; i < results.size(); ++i) {
    length += (results[i].T_odom_lidar.translation() - results[i - 1].T_odom_lidar.translation()).norm();
  }
  return length;
}

std::string run_repr(const PythonRun& run) {
  return text_of("<rilo.RunResult of %zu sweeps, %.1f m in %.1f s of computing%s>", run.session.results.size(),
                 path_m(run), run.session.wall_s, run.session.restart ? ", two passes" : "");
}

py::str run_html(const PythonRun& run) {
  const SessionResult& r = run.session;
  std::size_t ok = 0;
  for (const SweepResult& result : r.results) ok += result.status == OdometryStatus::kOk ? 1 : 0;
  HtmlRows rows{{"data", r.source.path.string()},
                {"sweeps", text_of("%zu, %zu of them ok", r.results.size(), ok)},
                {"path", text_of("%.1f m", path_m(run))},
                {"point times", r.source.point_times},
                {"time", text_of("%.1f s on %d threads", r.wall_s, r.threads)}};
  if (r.restart) {
    rows.emplace_back("passes", text_of("2: restarted after %zu sweeps with what they say about the sensor",
                                        r.restart->after_sweeps));
  }
  for (const std::string& warning : run.warnings) rows.emplace_back("warning", warning);
  return html_table("rilo.RunResult", rows);
}

void translate_run_error(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param): pybind11 says so
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const RunError& error) {
    switch (error.kind()) {
      case RunErrorKind::kUsage:
        PyErr_SetString(PyExc_ValueError, error.what());
        break;
      case RunErrorKind::kBadData:
      case RunErrorKind::kCannotWrite:
        PyErr_SetString(py::module_::import("rilo._rilo").attr("IoError").ptr(), error.what());
        break;
      case RunErrorKind::kUnexpected:
        PyErr_SetString(PyExc_RuntimeError, error.what());
        break;
    }
  }
}

}  // namespace

void add_run(py::module_& module) {
  py::register_exception_translator(translate_run_error);
  py::class_<PythonRun>(module, "RunResult", "Result of rilo.run(): poses, the results of all sweeps, the map.")
      .def_property_readonly(
          "trajectory",
          [](const PythonRun& run) {
            std::vector<SE3> poses;
            for (const SweepResult& result : run.session.results) poses.push_back(result.T_odom_lidar);
            return pose_array(poses);
          },
          "Poses T_odom_lidar, (N, 4, 4) float64.")
      .def_property_readonly(
          "stamps_ns",
          [](const PythonRun& run) {
            std::vector<std::int64_t> stamps;
            for (const SweepResult& result : run.session.results) stamps.push_back(result.stamp_ns);
            const auto size = static_cast<py::ssize_t>(stamps.size());
            return hand_over<std::int64_t>(std::move(stamps), {size});
          },
          "Times that the poses refer to, (N,) int64, ns.")
      .def_property_readonly(
          "results", [](const PythonRun& run) { return run.results; }, "SweepResult of every sweep.")
      .def_property_readonly(
          "indices", [](const PythonRun& run) { return run.session.indices; },
          "Place of every sweep in the data; skipped sweeps leave holes.")
      .def_property_readonly(
          "map", [](const PythonRun& run) { return run.map; },
          "Map of the whole run, odometry frame, (M, 3) float32, m; empty without map_voxel_m.")
      .def_property_readonly(
          "started_over_after",
          [](const PythonRun& run) {
            const std::optional<Restart>& restart = run.session.restart;
            return restart ? std::optional(restart->after_sweeps) : std::nullopt;
          },
          "Sweeps of the first pass when there was a second, else None.")
      .def_property_readonly(
          "config", [](const PythonRun& run) { return dump_config(run.session.config); },
          "Configuration of the run, YAML with all keys.")
      .def_property_readonly(
          "calibration",
          [](const PythonRun& run) {
            const std::string source = text_of("%zu sweeps of ", run.session.learnt_from);
            return python_text(dump_calibration(run.session.learnt, source + run.session.source.path.string()));
          },
          "What was learnt about the sensor's angles, YAML: to be written to a file, or for calibration=.")
      .def_property_readonly(
          "wall_s", [](const PythonRun& run) { return run.session.wall_s; }, "Duration of the run, s.")
      .def_property_readonly(
          "warnings", [](const PythonRun& run) { return run.warnings; }, "Sentences about what was found in the data.")
      .def("__len__", [](const PythonRun& run) { return run.session.results.size(); })
      .def("__repr__", run_repr)
      .def("_repr_html_", run_html);

  module.def("_run", run, py::arg("source"), py::arg("source_options"), py::kw_only(), py::arg("config"),
             py::arg("settings"), py::arg("calibration"), py::arg("start"), py::arg("count"), py::arg("one_pass"),
             py::arg("map_voxel_m"), py::arg("on_sweep"), py::arg("on_restart"), py::arg("on_progress"));
}

}  // namespace rilo::python
