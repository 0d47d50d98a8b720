// What rilo bench is to run: a plan or the paper's tables, with what the command line says.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bench/job.hpp"
#include "bench/runner.hpp"

namespace rilo::cli {

/// Options and arguments, of rilo bench and of its subcommands.
struct BenchFlags {
  std::string plan;
  std::vector<std::string> data;
  std::vector<std::string> peers;
  std::string peer_figures;
  std::string root;  // of the plan's sequences, or of the data set
  std::string config_file;
  std::vector<std::string> settings;
  std::optional<std::size_t> repeats;
  std::optional<std::size_t> cell;
  std::string format = "text";
  bool no_times = false;
  bool paired = false;
  BenchOrder order;
};

/// Of FILE; fills in the tables and the peers' figures of flags.order. @throws RunError, IoError, ConfigError
std::vector<BenchJob> plan_jobs(BenchFlags& flags);

/// Of KITTI or M2DGR, with one configuration; fills in the tables of flags.order. @throws as plan_jobs().
std::vector<BenchJob> paper_jobs(BenchFlags& flags, PaperTables tables);

}  // namespace rilo::cli
