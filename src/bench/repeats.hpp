// Repeats of a cell as one.
#pragma once

#include <vector>

#include "bench/cell.hpp"

namespace rilo {

/// One cell for all repeats of a configuration (or peer) on a sequence, in the order of their first ones. Times and
/// memory are the medians of the repeats; everything else is of the first, as nothing else may differ. It failed when
/// one of them did, or when they differ in what they found out.
std::vector<BenchCell> combined(const std::vector<BenchCell>& cells);

}  // namespace rilo
