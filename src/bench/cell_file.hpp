// A finished cell on disk: one file, whole or not there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "bench/cell.hpp"
#include "bench/job.hpp"

namespace rilo {

/// What became of a job: its cell first, then the peers.
struct CellRecord {
  std::vector<BenchCell> cells;
  std::size_t attempts = 1;
  std::string log;   ///< what the cell said, beside the results; empty: nothing was kept
  std::string host;  ///< that ran it

  bool failed() const { return cells.empty() || cells.front().failed(); }
};

constexpr const char* kCells = "cells";

/// That folder of a benchmark's results. Any number of processes, on any number of machines that share it, may
/// write to it.
class CellFolder {
 public:
  /// `kept`: whether the folder outlives the benchmark, so that logs can be named.
  /// @throws RunError, kCannotWrite, when `results`/cells cannot be created.
  CellFolder(const std::filesystem::path& results, bool kept);

  std::filesystem::path file(const BenchJob& job) const { return folder_ / (job.key + ".json"); }
  std::filesystem::path log(const BenchJob& job) const { return folder_ / (job.key + ".log"); }
  /// As written in results; empty when it is not kept.
  std::string log_name(const BenchJob& job) const { return kept_ ? "cells/" + job.key + ".log" : ""; }

  /// Nothing where there is no such file, or none that can be read: the cell is run again.
  std::optional<CellRecord> read(const BenchJob& job) const;
  /// @throws IoError
  void write(const BenchJob& job, const CellRecord& record) const;
  void remove(const BenchJob& job) const;

 private:
  std::filesystem::path folder_;
  bool kept_;
};

/// The figures of a cell; empty ones are omitted where it failed or is a peer's.
nlohmann::json metrics_json(const BenchCell& cell);

/// A cell without loss.
nlohmann::json packed(const BenchCell& cell);
BenchCell unpacked(const nlohmann::json& json);

}  // namespace rilo
