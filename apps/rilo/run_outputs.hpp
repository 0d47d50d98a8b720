// The files that a run leaves behind.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "run_flags.hpp"
#include "run_record.hpp"

namespace rilo::cli {

/// With all folders above it. @throws CommandError(kCannotWrite)
void create_folder(const std::filesystem::path& folder);

/// Makes sure, before anything is computed, that --out and --map can be written; --out is created.
/// @throws CommandError(kCannotWrite), or kUsage when --map ends in neither .ply nor .pcd.
void prepare_outputs(const RunFlags& flags);

/// Writes all result files, each whole or not at all. Optional files of an earlier run that this one does not have are
/// removed. @throws CommandError(kCannotWrite)
void write_outputs(const RunFlags& flags, const RunRecord& run, const nlohmann::json& metrics);

}  // namespace rilo::cli
