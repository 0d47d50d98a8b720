// Whether the outputs of a run would cost the user a file.
#pragma once

#include <filesystem>
#include <string>

#include "results/run_request.hpp"

namespace rilo {

/// Refuses outputs that are an input, lie among the data, or would replace files that no run has left.
/// `config_file`: as given; empty: none. @throws RunError, kCannotWrite
void check_outputs(const OutputRequest& outputs, const RunRequest& run, const std::filesystem::path& config_file);

/// Refuses a folder of results that holds sweeps, of `data` or others: results among data are read as data, or instead
/// of them. @throws RunError, kCannotWrite
void check_apart(const std::filesystem::path& folder, const std::filesystem::path& data);

/// Refuses to replace a file that lacks `mark` among its first bytes, as those of ours have it. Nothing is lost with an
/// empty one. `what`: "map of an earlier run"; `option` names the file. @throws RunError, kCannotWrite
void check_replaced(const std::filesystem::path& file, const std::string& mark, const std::string& what,
                    const std::string& option);

}  // namespace rilo
