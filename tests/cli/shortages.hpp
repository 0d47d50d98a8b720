// Too little of something.
#pragma once

#include <filesystem>
#include <sys/mount.h>
#include <sys/resource.h>

namespace rilo::test {

/// A limit for the processes that are started while it lives.
class Limit {
 public:
  Limit(int resource, rlim_t value) : resource_(resource) {
    ::getrlimit(static_cast<__rlimit_resource>(resource_), &before_);
    const rlimit limit{value, before_.rlim_max};
    ::setrlimit(static_cast<__rlimit_resource>(resource_), &limit);
  }
  ~Limit() { ::setrlimit(static_cast<__rlimit_resource>(resource_), &before_); }
  Limit(const Limit&) = delete;
  Limit& operator=(const Limit&) = delete;

 private:
  int resource_;
  rlimit before_{};
};

/// A disk of its own, where we may mount one.
class SmallDisk {
 public:
  SmallDisk(const std::filesystem::path& place, const char* options) : place_(place) {
    std::filesystem::create_directories(place);
    mounted_ = ::mount("none", place.c_str(), "tmpfs", 0, options) == 0;
  }
  ~SmallDisk() {
    if (mounted_) ::umount2(place_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  bool change(unsigned long flags, const char* options) const {
    return ::mount("none", place_.c_str(), "tmpfs", MS_REMOUNT | flags, options) == 0;
  }

 private:
  std::filesystem::path place_;
  bool mounted_;
};

}  // namespace rilo::test
