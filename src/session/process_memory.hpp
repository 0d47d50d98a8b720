// Memory of this process.
#pragma once

namespace rilo::detail {

/// The largest resident memory of this process so far, MB.
double peak_memory_mb();

}  // namespace rilo::detail
