// Results of a benchmark as one SQLite file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/figures.hpp"

namespace rilo {

/// A cell, each repeat of its own, and where it came from.
struct StoredCell {
  BenchCell cell;
  std::string key;  ///< of the job's description
  std::size_t attempts = 1;
  std::string host;
};

/// What `rilo bench show` needs.
struct BenchStore {
  BenchRecord bench;  ///< of it everything but the cells
  PaperTables tables = PaperTables::kNone;
  std::vector<StoredCell> cells;  ///< in the order of the plan
};

constexpr const char* kStoreName = "results.sqlite";

/// Writes the whole file again, under a temporary name first: readers see the old or the new one, and neither locks nor
/// a journal are needed where several machines share the folder. @throws IoError
void write_store(const std::filesystem::path& file, const BenchStore& store);

/// `place`: the file, or the folder it lies in. @throws IoError when it is none.
BenchStore read_store(const std::filesystem::path& place);

}  // namespace rilo
