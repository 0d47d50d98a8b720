// Sweeps that cannot be read and are skipped (OnBadSweep::kSkip).
#pragma once

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// Counts one; the first ones are warnings of their own.
void note_bad_sweep(const IoError& error, SourceInfo& info);
/// The warning with the number of those.
void add_bad_sweep_count(SourceInfo& info);

}  // namespace rilo::detail
