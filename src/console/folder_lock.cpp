#include "console/folder_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "rilo/session/session.hpp"

namespace rilo {

namespace {

// Of the descriptor: 0 it is ours, EWOULDBLOCK another process has it, else the file system cannot lock it.
int try_lock(int descriptor) {
  if (descriptor < 0) return errno;
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  // The folder itself where that can be locked: no file is left. NFS wants one that is open for writing.
  descriptor_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  int result = try_lock(descriptor_);
  if (result != 0 && result != EWOULDBLOCK) {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open((folder / ".rilo.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    result = try_lock(descriptor_);
  }
  if (result != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw RunError(
      RunErrorKind::kCannotWrite,
      folder.string() + ": another rilo is writing into this folder; wait until it has ended or choose another --out");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace rilo
