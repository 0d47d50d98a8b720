
#include "modules.hpp"
#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_rilo, module) {
  using namespace rilo::python;
  module.doc() = "LiDAR-only odometry. Metres, radians, int64 nanoseconds; T_a_b maps points of frame b to frame a.";
  module.attr("__version__") = RILO_VERSION;
  // The last one is asked first: a ConfigError is an IoError, too.
  py::register_exception<rilo::IoError>(module, "IoError", PyExc_OSError).doc() =
      "Data or a file cannot be read or written: file, position, what was found, what was expected.";
  py::register_exception<rilo::ConfigError>(module, "ConfigError", PyExc_ValueError).doc() =
      "An unknown key, or a value that a key cannot take.";
  add_results(module);
  add_odometry(module);
  add_sources(module);
  add_run(module);
  add_evaluation(module);
  add_files(module);
  add_simulation(module);
}
