// Processors that this process may use.
#pragma once

#include <tbb/info.h>

namespace rilo {

/// Those of its affinity mask (taskset, cpusets of containers and batch systems), as many as `threads = 0` uses.
inline int usable_processors() { return tbb::info::default_concurrency(); }

}  // namespace rilo
