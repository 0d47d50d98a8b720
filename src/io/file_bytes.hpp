// A whole file in memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace rilo::detail {

/// Whether there is anything of that name; false also when one may not look.
bool path_exists(const std::filesystem::path& path);

struct FileBytes {
  std::filesystem::path path;
  std::unique_ptr<char[]> data;
  std::size_t size = 0;

  std::string_view view() const { return {data.get(), size}; }
};

/// Reads at most `limit` bytes. Memory is what the file has, whatever it says about itself.
/// @throws IoError: missing, a folder or another thing that is not a regular file, not readable.
FileBytes read_file(const std::filesystem::path& path, std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace rilo::detail
