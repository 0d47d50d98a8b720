// What the result of a cell depends on, and the key that is made of it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "bench/job.hpp"

namespace rilo {

/// Describes jobs. The folders of data are looked through once each.
class Describer {
 public:
  /// `results`: the folder that the benchmark writes to, which may lie within the data.
  Describer(const BenchRunOptions& flags, std::filesystem::path results)
      : flags_(flags), results_(std::move(results)) {}

  /// Fills in description and key: data, truth, peers, how the data are read, configuration, program. Neither names
  /// nor the number of threads count, on which no result depends.
  void describe(BenchJob& job);

 private:
  const std::string& data_hash(const std::filesystem::path& data);

  const BenchRunOptions& flags_;
  std::filesystem::path results_;
  std::map<std::filesystem::path, std::string> hashes_;
};

}  // namespace rilo
