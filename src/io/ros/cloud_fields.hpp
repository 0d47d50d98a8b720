// The fields that the clouds of a recording have.
#pragma once

#include <filesystem>
#include <memory>

#include "io/ros/recording.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// What open_recording() opens, with SourceInfo::fields as the first message has them.
std::unique_ptr<ScanSource> open_with_fields(const std::filesystem::path& path, std::unique_ptr<Recording> recording,
                                             const SourceOptions& options);

}  // namespace rilo::detail
