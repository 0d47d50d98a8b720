// The bytes of files, in pieces or as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace rilo::detail {

/// Whether there is anything of that name, a regular file or a folder; false also when one may not look.
bool path_exists(const std::filesystem::path& path);
bool is_file(const std::filesystem::path& path);
bool is_folder(const std::filesystem::path& path);

/// A file that is read in pieces.
class RandomAccessFile {
 public:
  /// @throws IoError: missing, a folder or another thing that is not a regular file, not readable.
  explicit RandomAccessFile(std::filesystem::path path);
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Reads `count` bytes from `offset` into the front of `buffer`, which is as long afterwards.
  /// @throws IoError when the file ends first.
  void read(std::uint64_t offset, std::size_t count, std::vector<char>& buffer) const;

  /// Reads `count` bytes to `to`, fewer where the file ends, and returns how many. @throws IoError
  std::size_t read_some(std::uint64_t offset, std::size_t count, char* to) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

struct FileBytes {
  std::filesystem::path path;
  std::unique_ptr<char[]> data;
  std::size_t size = 0;

  std::string_view view() const { return {data.get(), size}; }
};

/// Reads at most `limit` bytes. Memory is what the file has, whatever it says about itself.
/// @throws IoError as RandomAccessFile.
FileBytes read_file(const std::filesystem::path& path, std::size_t limit = static_cast<std::size_t>(-1));

}  // namespace rilo::detail
