// Results appear whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace rilo {

/// Writes to a temporary file on the disk of `target`; commit() makes it durable and puts it in place. Without commit
/// (an exception, an early return) it goes away and `target` stays as it was. It has no name before commit() where the
/// file system can do that, so that a program that is killed leaves nothing either. All functions throw IoError: folder
/// missing or not writable, target not a regular file, disk full.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes (buffered).
  void write(std::string_view bytes);

  /// Replaces bytes that were written before, for headers whose counts are known only at the end.
  void overwrite(std::uint64_t offset, std::string_view bytes);

  /// Flushes, fsyncs, renames. Nothing may be written afterwards.
  void commit();

  /// A path to the temporary file, for a library that writes files by itself: it may truncate and write it, not replace
  /// it, and must be done before commit().
  std::filesystem::path temporary() const;

  const std::filesystem::path& target() const { return target_; }

 private:
  void flush();
  void give_name();
  void write_at(std::uint64_t offset, std::string_view bytes);
  void discard() noexcept;
  [[noreturn]] void fail(const std::string& action, int error_number);

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  int descriptor_ = -1;
  std::string buffer_;
  std::uint64_t flushed_ = 0;
};

/// The file that a temporary file of this name was to become ("a.txt" for ".a.txt.123-0.tmp"); none for other names.
std::optional<std::string> name_of_unfinished(std::string_view name);

/// The whole file in one call.
void write_atomically(const std::filesystem::path& target, std::string_view bytes);

}  // namespace rilo
