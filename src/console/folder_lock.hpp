// One writer a results folder.
#pragma once

#include <filesystem>

namespace rilo {

/// Held by the process as long as the object lives; gone with it however it ends, so nothing stale stays behind.
class FolderLock {
 public:
  /// Empty: no lock. @throws RunError, kCannotWrite, when another process has it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace rilo
