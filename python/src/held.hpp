// Calls of several threads on one object.
#pragma once

#include <mutex>
#include <pybind11/pybind11.h>

namespace rilo::python {

/// While it lives, an object is held by this thread, and Python's lock is let go: the others wait for the object alone.
class Held {
 public:
  explicit Held(std::mutex& mutex) : lock_(mutex) {}

 private:
  pybind11::gil_scoped_release others_go_on_;  // before the wait, and taken again after the end of the hold
  std::lock_guard<std::mutex> lock_;
};

}  // namespace rilo::python
