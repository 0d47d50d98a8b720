
#include "modules.hpp"
#include "notebook.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"

namespace py = pybind11;

namespace {

py::handle io_error;
py::handle config_error;

// Names of files in a text may be no UTF-8.
void raise_as(const py::handle& type, const char* what) {
  PyErr_SetObject(type.ptr(), rilo::python::python_text(what).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(std::move(thrown));
  } catch (const rilo::ConfigError& error) {
    raise_as(config_error, error.what());
  } catch (const rilo::IoError& error) {
    raise_as(io_error, error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_rilo, module) {
  using namespace rilo::python;
  module.doc() = "LiDAR-only odometry. Metres, radians, int64 nanoseconds; T_a_b maps points of frame b to frame a.";
  module.attr("__version__") = RILO_VERSION;
  io_error = py::exception<rilo::IoError>(module, "IoError", PyExc_OSError).release();
  io_error.doc() = "Data or a file cannot be read or written: file, position, what was found, what was expected.";
  config_error = py::exception<rilo::ConfigError>(module, "ConfigError", PyExc_ValueError).release();
  config_error.doc() = "An unknown key, or a value that a key cannot take.";
  py::register_exception_translator(translate);
  add_results(module);
  add_odometry(module);
  add_sources(module);
  add_run(module);
  add_evaluation(module);
  add_files(module);
  add_simulation(module);
}
