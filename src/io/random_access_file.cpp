#include "io/random_access_file.hpp"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "rilo/io/io_error.hpp"

namespace rilo::detail {

RandomAccessFile::RandomAccessFile(std::filesystem::path path)
    : path_(std::move(path)), descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const int error_number = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw IoError({path_, "", "cannot be read: " + std::generic_category().message(error_number), "a readable file",
                   error_number == ENOENT ? "Check the path" : "Check the permissions and the disk"});
  }
  if (!S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw IoError({path_, "", S_ISDIR(status.st_mode) ? "it is a folder" : "it is not a regular file", "a file",
                   "Give the path of a file"});
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

RandomAccessFile::~RandomAccessFile() { ::close(descriptor_); }

void RandomAccessFile::read(std::uint64_t offset, std::size_t count, std::vector<char>& buffer) const {
  if (offset > size_ || count > size_ - offset) {
    throw IoError({path_, "byte " + std::to_string(offset), "the end of the file at byte " + std::to_string(size_),
                   std::to_string(count) + " more bytes", "The file is cut off: copy or record it again"});
  }
  buffer.resize(count);
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::pread(descriptor_, buffer.data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      throw IoError(
          {path_, "byte " + std::to_string(offset + done),
           got == 0 ? "the file has become shorter" : "cannot be read: " + std::generic_category().message(errno),
           std::to_string(count - done) + " more bytes", "Check the disk, and that no other program writes the file"});
    }
    done += static_cast<std::size_t>(got);
  }
}

}  // namespace rilo::detail
