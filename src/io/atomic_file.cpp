#include "io/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "rilo/io/io_error.hpp"

namespace rilo {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kTemporaryEnd = ".tmp";
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::string remedy_for(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
      return "Free some disk space or write to another disk";
    case EACCES:
    case EPERM:
    case EROFS:
      return "Choose a folder that you may write to";
    default:
      return "Choose another output path";
  }
}

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

// A link is written through: the file that it points to is replaced or made, the link stays. What cannot even be looked
// at, as a name that is too long, is refused here: a file without a name would find it out at the end only.
fs::path resolved(const fs::path& target) {
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (status.type() == fs::file_type::none) {
    throw IoError({target, "", "cannot be written: " + error.message(), "", remedy_for(error.value())});
  }
  if (fs::exists(status)) {
    if (!fs::is_regular_file(status)) {
      throw IoError({target, "", fs::is_directory(status) ? "it is a folder" : "it is not a regular file",
                     "the name of a file to write", "Give a file name"});
    }
    return fs::canonical(target);
  }
  if (fs::is_symlink(fs::symlink_status(target, error))) return resolved(folder_of(target) / fs::read_symlink(target));
  const fs::path folder = folder_of(target);
  if (!fs::is_directory(folder, error)) {
    throw IoError({target, "", "its folder " + folder.string() + " does not exist", "an existing folder",
                   "Create the folder or choose another output path"});
  }
  return target;
}

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  constexpr std::size_t kMostOfName = 220;  // with what is added, of the 255 bytes of a name
  return target.parent_path() / fmt::format(".{}.{}-{}{}", target.filename().string().substr(0, kMostOfName),
                                            ::getpid(), counter++, kTemporaryEnd);
}

std::string_view digits_off(std::string_view& text) {
  const std::size_t others = text.find_last_not_of("0123456789");
  const std::size_t kept = others == std::string_view::npos ? 0 : others + 1;
  const std::string_view digits = text.substr(kept);
  text = text.substr(0, kept);
  return digits;
}

bool cut_end(std::string_view& text, std::string_view end) {
  if (text.size() < end.size() || text.substr(text.size() - end.size()) != end) return false;
  text.remove_suffix(end.size());
  return true;
}

// Without a name, so that nothing is left when the program is killed. -1 where there are no such files; a name can be
// given to them later by way of /proc only.
int open_nameless([[maybe_unused]] const fs::path& target) {
#ifdef O_TMPFILE
  if (::access("/proc/self/fd", X_OK) != 0) return -1;
  return ::open(folder_of(target).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#else
  return -1;
#endif
}

// A file that its owner keeps to himself stays so when it is replaced; where modes cannot be set, it is written all the
// same.
void keep_mode(int descriptor, const fs::path& target) {
  struct stat old = {};
  if (::stat(target.c_str(), &old) == 0) (void)::fchmod(descriptor, old.st_mode & 0777U);
}

// The rename itself must survive a power cut; where folders cannot be synced, nothing is lost.
void sync_folder(const fs::path& target) {
  const int descriptor = ::open(folder_of(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& target) : target_(resolved(target)) {
  descriptor_ = open_nameless(target_);
  if (descriptor_ >= 0) return;
  do {
    temporary_ = temporary_name(target_);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) {
    const int error_number = errno;
    temporary_.clear();
    fail("cannot create a file in its folder", error_number);
  }
}

AtomicFile::~AtomicFile() { discard(); }

void AtomicFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) flush();
  if (bytes.size() >= kBufferBytes) {
    write_at(flushed_, bytes);
    flushed_ += bytes.size();
  } else {
    buffer_.append(bytes);
  }
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  write_at(offset, bytes);
}

fs::path AtomicFile::temporary() const {
  return temporary_.empty() ? fs::path(fmt::format("/proc/self/fd/{}", descriptor_)) : temporary_;
}

void AtomicFile::commit() {
  flush();
  keep_mode(descriptor_, target_);
  if (::fsync(descriptor_) != 0) fail("cannot write", errno);
  if (temporary_.empty()) give_name();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail("cannot write", errno);
  if (!temporary_.empty() && ::rename(temporary_.c_str(), target_.c_str()) != 0) {
    fail("cannot put the finished file in place", errno);
  }
  temporary_.clear();
  sync_folder(target_);
}

// A link cannot take the place of another file, a rename can: only then a second name is needed.
void AtomicFile::give_name() {
  const fs::path file = temporary();
  for (fs::path name = target_;; name = temporary_name(target_)) {
    if (::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      if (name != target_) temporary_ = std::move(name);
      return;
    }
    if (errno != EEXIST) fail("cannot put the finished file in place", errno);
  }
}

void AtomicFile::flush() {
  write_at(flushed_, buffer_);
  flushed_ += buffer_.size();
  buffer_.clear();
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void AtomicFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

void AtomicFile::fail(const std::string& action, int error_number) {
  discard();
  throw IoError(
      {target_, "", action + ": " + std::generic_category().message(error_number), "", remedy_for(error_number)});
}

std::optional<std::string> name_of_unfinished(std::string_view name) {
  if (name.empty() || name.front() != '.' || !cut_end(name, kTemporaryEnd)) return std::nullopt;
  if (digits_off(name).empty() || !cut_end(name, "-")) return std::nullopt;
  if (digits_off(name).empty() || !cut_end(name, ".") || name.size() < 2) return std::nullopt;
  return std::string(name.substr(1));
}

void write_atomically(const fs::path& target, std::string_view bytes) {
  AtomicFile file(target);
  file.write(bytes);
  file.commit();
}

}  // namespace rilo
