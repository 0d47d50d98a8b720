#include "io/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, int error_number) {
  throw IoError({path, "", "cannot be read: " + std::generic_category().message(error_number), "a readable file",
                 error_number == ENOENT ? "Check the path" : "Check the permissions and the disk"});
}

}  // namespace

bool path_exists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

bool is_file(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

// Without O_NONBLOCK, opening a pipe would wait for its writer.
RandomAccessFile::RandomAccessFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const int error_number = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    fail(path_, error_number);
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw IoError({path_, "", S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file", "a file",
                   "Give the path of a file"});
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

std::size_t RandomAccessFile::read_some(std::uint64_t offset, std::size_t count, char* to) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, to + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path_, errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

void RandomAccessFile::read(std::uint64_t offset, std::size_t count, std::vector<char>& buffer) const {
  if (offset > size_ || count > size_ - offset) {
    throw IoError({path_, "byte " + std::to_string(offset), "the end of the file at byte " + std::to_string(size_),
                   std::to_string(count) + " more bytes", "The file is cut off: copy or record it again"});
  }
  buffer.resize(count);
  const std::size_t done = read_some(offset, count, buffer.data());
  if (done == count) return;
  throw IoError({path_, "byte " + std::to_string(offset + done), "the file has become shorter",
                 std::to_string(count - done) + " more bytes",
                 "Check the disk, and that no other program writes the file"});
}

FileBytes read_file(const std::filesystem::path& path, std::size_t limit) {
  const RandomAccessFile file(path);
  const std::size_t wanted = std::min(static_cast<std::size_t>(file.size()), limit);
  FileBytes bytes{path, std::make_unique_for_overwrite<char[]>(std::max<std::size_t>(wanted, 1)), 0};
  bytes.size = file.read_some(0, wanted, bytes.data.get());
  return bytes;
}

}  // namespace rilo::detail
