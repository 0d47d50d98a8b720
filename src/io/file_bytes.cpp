#include "io/file_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::filesystem::path& path, int error_number) {
  throw IoError({path, "", "cannot be read: " + std::generic_category().message(error_number), "a readable file",
                 error_number == ENOENT ? "Check the path" : "Check the permissions and the disk"});
}

}  // namespace

bool path_exists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

FileBytes read_file(const std::filesystem::path& path, std::size_t limit) {
  // Without O_NONBLOCK, opening a pipe would wait for its writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) fail(path, errno);
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) fail(path, errno);
  if (!S_ISREG(status.st_mode)) {
    throw IoError({path, "", S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file", "a file",
                   "Give the path of a file"});
  }
  FileBytes bytes;
  bytes.path = path;
  const std::size_t wanted = std::min(static_cast<std::size_t>(status.st_size), limit);
  bytes.data = std::make_unique_for_overwrite<char[]>(std::max<std::size_t>(wanted, 1));
  while (bytes.size < wanted) {
    const ssize_t count = ::read(file.get(), bytes.data.get() + bytes.size, wanted - bytes.size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path, errno);
    if (count == 0) break;  // the file has shrunk since fstat
    bytes.size += static_cast<std::size_t>(count);
  }
  return bytes;
}

}  // namespace rilo::detail
