// The SQLite3 file of a rosbag2.
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <sqlite3.h>
#include <string>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/ros/recording.hpp"
#include "io/ros/unpack.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct Finalize {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

class Database {
 public:
  explicit Database(const std::filesystem::path& path) : path_(path) {
    if (!is_file(path)) {
      throw IoError({path, "", "no regular file of this name", "the SQLite3 file of a rosbag2", "Check the path"});
    }
    // Without a write-ahead log nothing but the file itself is touched: folders that may not be written to are fine.
    std::error_code error;
    const std::filesystem::path log = path.string() + "-wal";
    const bool has_log = path_exists(log) && std::filesystem::file_size(log, error) > 0;
    const std::string uri = "file:" + escaped(path.string()) + (has_log ? "?mode=ro" : "?mode=ro&immutable=1");
    sqlite3* raw = nullptr;
    const int code = sqlite3_open_v2(uri.c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) fail("cannot be opened: ");
    // A file may come from anybody: its schema runs nothing.
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestUnpacked) - 1);
    sqlite3_limit(raw, SQLITE_LIMIT_SQL_LENGTH, 1 << 16);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    std::uint64_t bytes = std::filesystem::file_size(path, error);
    if (has_log) bytes += std::filesystem::file_size(log, error);
    limit_work(bytes);
  }

  Database(const Database&) = delete;  // SQLite has its address
  Database& operator=(const Database&) = delete;

  const std::filesystem::path& path() const { return path_; }

  Statement prepare(const std::string& sql) const {
    work_left_ = most_work_;
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK) fail("");
    return Statement(raw);
  }

  // False after the last row.
  bool step(sqlite3_stmt* statement) const {
    const int code = sqlite3_step(statement);
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    fail("");
  }

  static std::string text(sqlite3_stmt* statement, int column) {
    const auto* bytes = sqlite3_column_text(statement, column);
    const int size = sqlite3_column_bytes(statement, column);
    return bytes == nullptr ? "" : std::string(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  }

 private:
  // Pages that are the children of one another many times over make a small file one of rows without end. A row takes
  // ten bytes at least and some twenty operations: for each statement, there may be five times as many.
  void limit_work(std::uint64_t bytes) {
    constexpr int kOperations = 10'000;  // from one look to the next
    most_work_ = 100 + bytes / (kOperations / 10);
    const auto look = [](void* self) { return static_cast<Database*>(self)->work_left_-- == 0 ? 1 : 0; };
    sqlite3_progress_handler(database_.get(), kOperations, look, this);
  }

  [[noreturn]] void fail(const std::string& what) const {
    const bool endless = sqlite3_errcode(database_.get()) == SQLITE_INTERRUPT;
    const std::string why = endless ? "it has more rows than its bytes can hold"
                                    : std::string("SQLite3: ") + sqlite3_errmsg(database_.get());
    throw IoError({path_, "", what + why, "a rosbag2 database with the tables topics and messages",
                   "Copy the recording again; where the recorder was killed, sqlite3's .recover may help"});
  }
  static std::string escaped(const std::string& path) {
    std::string text;
    for (const char letter : path) {
      if (letter == '%' || letter == '?' || letter == '#') {
        constexpr const char* kDigits = "0123456789abcdef";
        text += {'%', kDigits[(letter >> 4) & 15], kDigits[letter & 15]};
      } else {
        text += letter;
      }
    }
    return text;
  }

  std::filesystem::path path_;
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::uint64_t most_work_ = 0;  // of a statement
  mutable std::uint64_t work_left_ = 0;
};

class Db3Reader final : public Recording {
 public:
  explicit Db3Reader(const std::filesystem::path& path) : database_(path) {
    check_tables();
    const Statement rows = database_.prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (database_.step(rows.get())) {
      ids_.push_back(sqlite3_column_int64(rows.get(), 0));
      std::string encoding = Database::text(rows.get(), 3);
      if (encoding.empty()) encoding = "cdr";  // some writers leave it out, and ROS 2 has no other
      topics_.push_back({Database::text(rows.get(), 1), Database::text(rows.get(), 2), std::move(encoding), 0});
    }
    count_messages();
  }

  std::string format() const override { return "rosbag2 (sqlite3)"; }
  const std::vector<RecordedTopic>& topics() const override { return topics_; }

  void select(const RecordedTopic& topic) override {
    std::string ids;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (topics_[i].has_same_messages(topic)) ids += (ids.empty() ? "" : ", ") + std::to_string(ids_[i]);
    }
    // In the order of the rows: they are read one by one, whatever the size of the file.
    rows_ = database_.prepare("SELECT id, timestamp, data FROM messages WHERE topic_id IN (" + ids + ") ORDER BY id");
  }

  std::optional<RecordedMessage> next() override {
    if (!step()) return std::nullopt;
    RecordedMessage message{sqlite3_column_int64(rows_.get(), 1), {}, database_.path()};
    const void* data = sqlite3_column_blob(rows_.get(), 2);
    const int size = sqlite3_column_bytes(rows_.get(), 2);
    if (data != nullptr) message.bytes = {static_cast<const char*>(data), static_cast<std::size_t>(size)};
    return message;
  }

  std::size_t skip(std::size_t count) override {
    std::size_t skipped = 0;
    while (skipped < count && step()) ++skipped;  // the column with the data is not touched: its pages are not read
    return skipped;
  }

 private:
  // Plain tables only: a view or a virtual table could compute for ever.
  void check_tables() const {
    for (const char* name : {"topics", "messages"}) {
      const Statement row = database_.prepare("SELECT type, sql FROM sqlite_master WHERE name = '" + std::string(name) +
                                              "' AND type IN ('table', 'view')");
      const bool found = database_.step(row.get());
      const std::string sql = found ? lower_case(Database::text(row.get(), 1)) : "";
      if (found && Database::text(row.get(), 0) == "table" && sql.rfind("create table", 0) == 0) continue;
      throw IoError({database_.path(), "", std::string("no table ") + name,
                     "a rosbag2 database with the tables topics and messages",
                     "Check what database this is; the recorder may not have got to write anything"});
    }
  }

  void count_messages() {
    const Statement rows = database_.prepare("SELECT topic_id, COUNT(*) FROM messages GROUP BY topic_id");
    while (database_.step(rows.get())) {
      const auto place = std::find(ids_.begin(), ids_.end(), sqlite3_column_int64(rows.get(), 0));
      if (place == ids_.end()) continue;
      topics_[static_cast<std::size_t>(place - ids_.begin())].messages =
          static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 1));
    }
  }

  // A damaged page ends the recording: SQLite cannot continue after it.
  bool step() {
    if (!rows_) return false;
    try {
      if (database_.step(rows_.get())) return true;
    } catch (const IoError&) {
      rows_.reset();
      throw;
    }
    rows_.reset();
    return false;
  }

  Database database_;
  std::vector<sqlite3_int64> ids_;
  std::vector<RecordedTopic> topics_;
  Statement rows_;
};

}  // namespace

std::unique_ptr<Recording> open_db3(const std::filesystem::path& file) { return std::make_unique<Db3Reader>(file); }

}  // namespace rilo::detail
