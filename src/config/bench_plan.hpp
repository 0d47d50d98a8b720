// What `rilo bench` runs: sequences and configurations, from YAML.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rilo/config/config_file.hpp"
#include "rilo/io/source_options.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// Poses that another program computed for a sequence.
struct BenchPeer {
  std::string name;
  std::filesystem::path poses;
};

/// One drive of a benchmark.
struct BenchSequence {
  std::string name;
  std::filesystem::path path;          ///< data, as for `rilo run`
  std::filesystem::path ground_truth;  ///< pose file; empty: what lies beside the data
  std::filesystem::path calibration;   ///< angles of the sensor, calibration.yaml of another run; empty: none
  bool camera_frame = false;           ///< given pose files are in the camera frame (`Tr` of calib.txt)
  double max_gap_s = 0.02;             ///< given pose files with stamps: largest distance to a sweep's pose
  std::size_t start = 0;               ///< sweeps skipped
  std::size_t count = 0;               ///< 0: all
  std::optional<PointTimes> point_times;
  std::optional<double> elevation_correction_deg;
  std::vector<BenchPeer> peers;
  std::string group;  ///< of sequences that are summed up together, "tuning" say; empty: none
};

/// Among the settings of a configuration: before the name of its file.
inline constexpr std::string_view kConfigWord = "config ";

/// One way to run them.
struct BenchConfiguration {
  std::string name;
  OdometryConfig config;
  std::vector<std::string> settings;  ///< the file's name, key=value and the elevation correction, for the results
  std::optional<double> elevation_correction_deg = std::nullopt;  ///< goes before that of the sequence
};

/// Tables of the paper that the results go into.
enum class PaperTables : std::uint8_t { kNone, kKitti, kM2dgr };

struct BenchPlan {
  std::vector<BenchSequence> sequences;
  std::vector<BenchConfiguration> configurations;  ///< never empty
  std::size_t repeats = 1;                         ///< of each configuration on each sequence
  bool skip_missing = false;                       ///< sequences whose data are not there are left out
  PaperTables tables = PaperTables::kNone;
  std::vector<BenchPeer> peers;        ///< of every sequence: the file with {sequence} for its name
  std::filesystem::path peer_figures;  ///< CSV of figures of peers; empty: none
};

/// Whether a configuration of the plan goes by that name, so that no peer may: results are looked up by these names.
bool has_configuration(const BenchPlan& plan, const std::string& name);

/// Gives every sequence those of `plan.peers` that it has not of its own.
void give_peers(BenchPlan& plan);

/// Reads a plan; docs/bench.md describes the file. Relative paths of sequences count from `root`, or from the file's
/// folder when that is empty; those of configurations always from the file's folder. Configurations are loaded at once,
/// sequences are not looked for. Without `configurations:` there is one, "default".
/// @throws ConfigError with line and column: no YAML, unknown or repeated key or name, wrong type, a configuration that
/// cannot be loaded.
BenchPlan load_bench_plan(const std::filesystem::path& file, const std::filesystem::path& root = {});

/// The same from text; `file` stands in messages and gives the folder.
BenchPlan parse_bench_plan(std::string_view yaml, const std::filesystem::path& file,
                           const std::filesystem::path& root = {});

}  // namespace rilo
