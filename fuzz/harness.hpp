// What the harnesses share: files in memory, and the rule that IoError is the only exception a parser throws.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <unistd.h>

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::fuzz {

/// Bytes under a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written <= 0) std::abort();
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    ::lseek(descriptor_, 0, SEEK_SET);
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

inline std::string_view bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Any other exception ends the program.
template <typename Action>
void only_io_errors(Action&& action) {
  try {
    action();
  } catch (const IoError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
}

/// To the end, past errors, which must not go on for ever.
inline void read_all(ScanSource& source) {
  constexpr int kMostErrors = 100'000;
  for (int errors = 0; errors < kMostErrors;) {
    try {
      while (source.next()) {
      }
      static_cast<void>(source.info());
      return;
    } catch (const IoError&) {
      ++errors;
    }
  }
  std::abort();
}

/// `text` up to the first zero byte, and what follows it.
struct Halves {
  std::string_view first;
  std::string_view second;
};
inline Halves split(std::string_view bytes) {
  const std::size_t zero = bytes.find('\0');
  if (zero == std::string_view::npos) return {bytes, {}};
  return {bytes.substr(0, zero), bytes.substr(zero + 1)};
}

}  // namespace rilo::fuzz
