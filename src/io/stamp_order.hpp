// Sweeps in the order of their stamps: what cannot be used is dropped and counted.
#pragma once

#include <memory>

#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// Watches the stamps of `inner`: counts gaps, drops duplicates and sweeps that come after a newer one, and goes
/// on when the clock was set back. See StampFaults.
std::unique_ptr<ScanSource> with_stamp_order(std::unique_ptr<ScanSource> inner);

}  // namespace rilo::detail
