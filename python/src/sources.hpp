// Sweeps as Python sees them, and how data are opened.
#pragma once

#include <memory>

#include "rilo/cloud/sweep.hpp"
#include "rilo/io/source_options.hpp"

namespace rilo::python {

/// A sweep whose columns numpy looks into; they live as long as one of them is used.
struct SharedSweep {
  std::shared_ptr<Sweep> sweep;
};

}  // namespace rilo::python
