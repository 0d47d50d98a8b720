// Whether the outputs of a run would cost the user a file.
#pragma once

#include <filesystem>

#include "results/run_request.hpp"

namespace rilo {

/// Refuses outputs that are an input, lie among the data, or would replace files that no run has left.
/// `config_file`: as given; empty: none. @throws RunError, kCannotWrite
void check_outputs(const OutputRequest& outputs, const RunRequest& run, const std::filesystem::path& config_file);

}  // namespace rilo
