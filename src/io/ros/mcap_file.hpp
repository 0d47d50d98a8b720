// The records of an MCAP file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.hpp"
#include "io/random_access_file.hpp"
#include "io/ros/mcap_records.hpp"

namespace rilo::detail::mcap {

inline constexpr std::size_t kRecordHeader = 9;  // opcode and length

struct Record {
  Opcode opcode = Opcode::kHeader;
  std::uint64_t offset = 0;   ///< of the record
  std::uint64_t content = 0;  ///< of what follows its header
  std::uint64_t length = 0;   ///< of that

  std::uint64_t end() const { return content + length; }
};

class RecordFile {
 public:
  /// @throws IoError when it is not an MCAP file.
  explicit RecordFile(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return file_.path(); }
  std::uint64_t size() const { return file_.size(); }

  /// The record at `offset`, or nothing where the file ends. A record that is cut off is the end, too, with a warning.
  std::optional<Record> record_at(std::uint64_t offset);

  /// The content, valid until the next call. @throws IoError when it is absurdly large or cannot be read.
  std::string_view content_of(const Record& record);

  /// Calls `use` with a cursor over the content.
  template <typename Use>
  void look_into(const Record& record, Use&& use) {
    const std::string_view content = content_of(record);
    const BytesOrigin origin = origin_of(record.offset);
    use(ByteCursor(content, origin, kRecordHeader));
  }

  const std::vector<std::string>& warnings() const { return warnings_; }
  void forget_warnings() { warnings_.clear(); }

 private:
  BytesOrigin origin_of(std::uint64_t offset) const;
  void note_cut(std::uint64_t offset);

  RandomAccessFile file_;
  std::vector<char> bytes_;
  std::vector<std::string> warnings_;
};

}  // namespace rilo::detail::mcap
