// The files that a run leaves behind.
#pragma once

#include <filesystem>
#include <functional>

#include "results/metrics.hpp"
#include "results/run_record.hpp"
#include "results/run_request.hpp"

namespace rilo {

/// Calls `write`. @throws RunError, kCannotWrite, for what it cannot write or remove.
void guard_writing(const std::function<void()>& write);

/// With all folders above it. @throws RunError, kCannotWrite
void create_folder(const std::filesystem::path& folder);

/// Makes sure, before anything is computed, that --out and --map can be written; --out is created.
/// @throws RunError, kCannotWrite, or kUsage when --map ends in neither .ply nor .pcd.
void prepare_outputs(const OutputRequest& flags);

/// Writes all result files, each whole or not at all. Optional files of an earlier run that this one does not have are
/// removed. @throws RunError, kCannotWrite
void write_outputs(const OutputRequest& flags, const RunRecord& run, const RunMetrics& metrics);

}  // namespace rilo
