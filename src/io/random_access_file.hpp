// A file that is read in pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace rilo::detail {

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

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace rilo::detail
