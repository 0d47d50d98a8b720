// The parts of the Python module.
#pragma once

#include <pybind11/pybind11.h>

namespace rilo::python {

void add_odometry(pybind11::module_& module);
void add_results(pybind11::module_& module);
void add_run(pybind11::module_& module);
void add_sources(pybind11::module_& module);
void add_evaluation(pybind11::module_& module);
void add_files(pybind11::module_& module);
void add_simulation(pybind11::module_& module);

}  // namespace rilo::python
