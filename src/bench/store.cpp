#include "bench/store.hpp"

#include <array>
#include <memory>
#include <sqlite3.h>

#include "bench/cell_file.hpp"
#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "io/file_bytes.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace fs = std::filesystem;

namespace {

constexpr const char* kSchema = R"(
CREATE TABLE experiment (name TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE cells (id INTEGER PRIMARY KEY, sequence TEXT NOT NULL, configuration TEXT NOT NULL,
  repeat INTEGER NOT NULL, kind TEXT NOT NULL, state TEXT NOT NULL, error TEXT NOT NULL, log TEXT NOT NULL,
  key TEXT NOT NULL, attempts INTEGER NOT NULL, host TEXT NOT NULL, record TEXT NOT NULL);
CREATE TABLE figures (cell INTEGER NOT NULL REFERENCES cells, name TEXT NOT NULL, value REAL NOT NULL,
  PRIMARY KEY (cell, name)) WITHOUT ROWID;
PRAGMA user_version = 1;
)";
constexpr int kUserVersion = 1;
constexpr const char* kExpectedStore = "results.sqlite of rilo bench, or the folder it lies in";
constexpr std::array<const char*, 3> kTableNames = {"none", "kitti", "m2dgr"};

struct CloseStore {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};
struct EndStatement {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};

class StoreFile {
 public:
  // An empty one in memory, or an existing one to read.
  explicit StoreFile(const fs::path& file, bool read) : file_(file) {
    sqlite3* raw = nullptr;
    const int flags = read ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_MEMORY;
    const int code = sqlite3_open_v2(read ? file.c_str() : ":memory:", &raw, flags, nullptr);
    database_.reset(raw);
    if (code != SQLITE_OK) fail();
  }

  void run(const char* sql) {
    if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }

  void prepare(const char* sql) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &raw, nullptr) != SQLITE_OK) fail();
    statement_.reset(raw);
  }

  StoreFile& bind(int place, const std::string& text) {
    sqlite3_bind_text(statement_.get(), place, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    return *this;
  }
  StoreFile& bind(int place, std::size_t number) {
    sqlite3_bind_int64(statement_.get(), place, static_cast<sqlite3_int64>(number));
    return *this;
  }
  StoreFile& bind(int place, double number) {
    sqlite3_bind_double(statement_.get(), place, number);
    return *this;
  }

  // False after the last row.
  bool step() {
    const int code = sqlite3_step(statement_.get());
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
    if (code == SQLITE_DONE) sqlite3_reset(statement_.get());
    return code == SQLITE_ROW;
  }

  std::string text(int column) const {
    const auto* bytes = sqlite3_column_text(statement_.get(), column);
    return bytes == nullptr ? "" : reinterpret_cast<const char*>(bytes);
  }
  std::size_t number(int column) const {
    return static_cast<std::size_t>(sqlite3_column_int64(statement_.get(), column));
  }

  std::string bytes() const {
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, void (*)(void*)> all(sqlite3_serialize(database_.get(), "main", &size, 0),
                                                              sqlite3_free);
    if (!all) throw std::bad_alloc();
    return {reinterpret_cast<const char*>(all.get()), static_cast<std::size_t>(size)};
  }

 private:
  [[noreturn]] void fail() const {
    throw IoError({file_, "", std::string("SQLite3: ") + sqlite3_errmsg(database_.get()), kExpectedStore, ""});
  }

  fs::path file_;
  std::unique_ptr<sqlite3, CloseStore> database_;
  std::unique_ptr<sqlite3_stmt, EndStatement> statement_;
};

void write_cells(StoreFile& file, const std::vector<StoredCell>& cells) {
  file.prepare("INSERT INTO cells VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const BenchCell& cell = cells[i].cell;
    file.bind(1, i + 1).bind(2, cell.sequence).bind(3, cell.configuration).bind(4, cell.repeat);
    file.bind(5, std::string(cell.peer ? "peer" : "run")).bind(6, std::string(cell.failed() ? "failed" : "done"));
    file.bind(7, cell.error).bind(8, cell.log).bind(9, cells[i].key).bind(10, cells[i].attempts);
    file.bind(11, cells[i].host).bind(12, json_text(packed(cell))).step();
  }
  file.prepare("INSERT INTO figures VALUES (?1, ?2, ?3)");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const BenchFigure& figure : bench_figures()) {
      const auto value = value_of(cells[i].cell, figure);
      if (value) file.bind(1, i + 1).bind(2, std::string(figure.key)).bind(3, *value).step();
    }
  }
}

nlohmann::json experiment_json(const BenchStore& store) {
  return {{"command", store.bench.command_line},
          {"planned", store.bench.planned},
          {"run", store.bench.run},
          {"signal", store.bench.signal},
          {"count", store.bench.count},
          {"tables", kTableNames[static_cast<std::size_t>(store.tables)]}};
}

void read_experiment(const nlohmann::json& json, BenchStore& store) {
  store.bench.command_line = json.at("command");
  store.bench.planned = json.at("planned");
  store.bench.run = json.at("run");
  store.bench.signal = json.at("signal");
  store.bench.count = json.value("count", std::size_t{0});  // stores of before 29 November 2026 have none
  for (std::size_t i = 0; i < kTableNames.size(); ++i) {
    if (json.at("tables") == kTableNames[i]) store.tables = static_cast<PaperTables>(i);
  }
}

}  // namespace

void write_store(const fs::path& target, const BenchStore& store) {
  StoreFile file(target, false);
  file.run(kSchema);
  file.run("BEGIN");
  file.prepare("INSERT INTO experiment VALUES (?1, ?2)");
  const nlohmann::json experiment = experiment_json(store);
  for (const auto& [name, value] : experiment.items()) file.bind(1, name).bind(2, value.dump()).step();
  write_cells(file, store.cells);
  file.run("COMMIT");
  write_atomically(target, file.bytes());
}

BenchStore read_store(const fs::path& place) {
  const fs::path target = detail::is_folder(place) ? place / kStoreName : place;
  if (!detail::is_file(target)) throw IoError({target, "", "no file of this name", kExpectedStore, ""});
  StoreFile file(target, true);
  BenchStore store;
  try {
    file.prepare("PRAGMA user_version");
    if (!file.step() || file.number(0) != kUserVersion) {
      throw IoError({target, "", "a database of another kind", kExpectedStore, ""});
    }
    file.prepare("SELECT name, value FROM experiment");
    nlohmann::json experiment;
    while (file.step()) experiment[file.text(0)] = nlohmann::json::parse(file.text(1));
    read_experiment(experiment, store);
    file.prepare("SELECT record, repeat, log, key, attempts, host FROM cells ORDER BY id");
    while (file.step()) {
      StoredCell stored{unpacked(nlohmann::json::parse(file.text(0))), file.text(3), file.number(4), file.text(5)};
      stored.cell.repeat = file.number(1);
      stored.cell.log = file.text(2);
      store.cells.push_back(stored);
    }
  } catch (const nlohmann::json::exception& error) {
    throw IoError({target, "", std::string("records that are none (") + error.what() + ")", kExpectedStore, ""});
  }
  return store;
}

}  // namespace rilo
