// Sweeps that cannot be read and are skipped (OnBadSweep::kSkip).
#pragma once

#include <cstddef>

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// Counts what the error took; the first errors are warnings of their own.
void note_bad_sweep(const IoError& error, SourceInfo& info, std::size_t sweeps = 1);
/// The warning with the number of those.
void add_bad_sweep_count(SourceInfo& info);

}  // namespace rilo::detail
