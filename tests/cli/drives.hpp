// Drives to run the command on.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "cli/command_process.hpp"

namespace rilo::test {

constexpr std::size_t kDriveSweeps = 12;

/// A moving VLP-16 drive of kDriveSweeps sweeps, simulated once a process; for reading only.
const std::filesystem::path& shared_drive();

/// A copy of it for a test that spoils it.
std::filesystem::path copy_of_drive(const TempDir& folder);

/// A folder of `sweeps` .bin files that are the drive's, forth and back: long enough to be interrupted.
std::filesystem::path long_folder(const TempDir& folder, std::size_t sweeps);

/// velodyne/000007.bin and so on.
std::filesystem::path sweep_file(const std::filesystem::path& drive, std::size_t index);

void append(const std::filesystem::path& file, std::size_t bytes);
void replace(const std::filesystem::path& file, const std::string& bytes);

/// Lines that end with a line break; 0 where there is no such file yet.
std::size_t complete_lines(const std::filesystem::path& file);

nlohmann::json json_file(const std::filesystem::path& file);

}  // namespace rilo::test
