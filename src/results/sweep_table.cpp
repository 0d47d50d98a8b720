#include "results/sweep_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "results/csv_file.hpp"

namespace rilo {

namespace {

constexpr CsvKind kSweepsCsv{"sweeps.csv of rilo run", "Run rilo run again",
                             "Give the folder that --out of rilo run named"};

struct SweepRow {
  std::size_t index = 0;
  SweepResult result;
};

struct Column {
  std::string name;
  bool needed;  // for reading
  std::function<std::string(const SweepRow&)> write;
  std::function<void(const CsvFile&, SweepRow&)> read;  // empty: follows from others
};

template <typename Enum>
constexpr std::size_t kWords = 0;
template <>
constexpr std::size_t kWords<OdometryStatus> = kStatusCount;
template <>
constexpr std::size_t kWords<LossCause> = kLossCauseCount;
template <>
constexpr std::size_t kWords<InitialPoseSource> = 3;
template <>
constexpr std::size_t kWords<InitialPoseReason> = 8;

template <typename Value>
std::string cell_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return std::string(to_string(value));
  } else if constexpr (std::is_same_v<Value, bool>) {
    return value ? "1" : "0";
  } else {
    return fmt::format("{}", value);
  }
}

template <typename Value>
void read_cell(const CsvFile& line, const std::string& column, Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    for (std::size_t i = 0; i < kWords<Value>; ++i) {
      value = static_cast<Value>(i);
      if (to_string(value) == line.cell(column)) return;
    }
    line.refuse(column, "one of the words of docs/command.md");
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = line.number<int>(column) != 0;
  } else {
    value = line.number<Value>(column);
  }
}

enum class Need : std::uint8_t { kNo, kYes };

class Columns {
 public:
  // `field`: row → reference to the value.
  template <typename Field>
  void add(const std::string& name, Field field, Need need = Need::kNo) {
    columns.push_back({name, need == Need::kYes, [field](const SweepRow& row) { return cell_of(field(row)); },
                       [name, field](const CsvFile& line, SweepRow& row) { read_cell(line, name, field(row)); }});
  }
  // A field of SweepStats or of its times.
  template <typename Value>
  void stat(const std::string& name, Value SweepStats::*member, Need need = Need::kNo) {
    add(
        name, [member](auto& row) -> auto& { return row.result.stats.*member; }, need);
  }
  void time(const std::string& name, double StageTimes::*member) {
    add(
        name, [member](auto& row) -> auto& { return row.result.stats.times.*member; }, Need::kYes);
  }
  void derived(const std::string& name, std::function<double(const SweepResult&)> value) {
    columns.push_back(
        {name, false, [value = std::move(value)](const SweepRow& row) { return cell_of(value(row.result)); }, {}});
  }

  std::vector<Column> columns;
};

void add_uncertainty(Columns& table) {
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(SweepStats::relative_eigenvalues)>; ++i) {
    table.add(
        fmt::format("eigenvalue_{}", i + 1), [i](auto& row) -> auto& {
          return row.result.stats.relative_eigenvalues.at(i);
        });
  }
  constexpr std::array<const char*, 6> kAxes = {"roll_rad", "pitch_rad", "yaw_rad", "x_m", "y_m", "z_m"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const std::string name = std::string("sigma_") + kAxes.at(i);
    table.columns.push_back(
        {name, false,
         [k](const SweepRow& row) { return cell_of(std::sqrt(std::max(0.0, row.result.covariance(k, k)))); },
         [name, k](const CsvFile& line, SweepRow& row) {
           row.result.covariance(k, k) = std::pow(line.number<double>(name), 2);
         }});
  }
}

void add_statistics(Columns& table) {
  using S = SweepStats;
  table.stat("points_in", &S::points_in);
  table.stat("points_valid", &S::points_valid);
  table.stat("points_isolated", &S::points_isolated);
  table.stat("points_map", &S::points_map);
  table.stat("points_source", &S::points_source);
  table.stat("map_voxels", &S::map_voxels);
  table.stat("initial_pose", &S::initial_pose, Need::kYes);
  table.stat("initial_pose_reason", &S::initial_pose_reason);
  table.stat("coarse_ran", &S::coarse_ran);
  table.stat("coarse_iterations", &S::coarse_iterations);
  table.stat("pred_align_distance_m", &S::pred_align_distance_m);
  table.stat("prediction_score", &S::prediction_score);
  table.stat("map_score", &S::map_score);
  table.stat("iterations", &S::iterations, Need::kYes);
  table.stat("converged", &S::converged);
  table.stat("inliers", &S::inliers);
  table.stat("inlier_ratio", &S::inlier_ratio, Need::kYes);
  table.stat("residual_rms_m", &S::residual_rms_m);
  table.stat("sigma_th_m", &S::sigma_th_m, Need::kYes);
  table.stat("gamma", &S::gamma);
  table.stat("deviation_m", &S::deviation_m);
  table.stat("elevation_offset_rad", &S::elevation_offset_rad);
  table.stat("elevation_applied_rad", &S::elevation_applied_rad);
  table.stat("beam_elevation_rms_rad", &S::beam_elevation_rms_rad);
  table.stat("beam_azimuth_rms_rad", &S::beam_azimuth_rms_rad);
  table.stat("loss_cause", &S::loss_cause);
  table.stat("impossible_motion", &S::impossible_motion);
  table.stat("points_cut", &S::points_cut);
  table.stat("coarse_cut", &S::coarse_cut);
  table.stat("over_budget", &S::over_budget);
}

std::vector<Column> all_columns() {
  Columns table;
  table.add(
      "sweep", [](auto& row) -> auto& { return row.index; }, Need::kYes);
  table.add(
      "stamp_ns", [](auto& row) -> auto& { return row.result.stamp_ns; }, Need::kYes);
  table.add(
      "status", [](auto& row) -> auto& { return row.result.status; }, Need::kYes);
  add_statistics(table);
  table.derived("speed_m_s", [](const SweepResult& r) { return r.twist.tail<3>().norm(); });
  table.derived("turn_rate_rad_s", [](const SweepResult& r) { return r.twist.head<3>().norm(); });
  add_uncertainty(table);
  table.time("preprocess_ms", &StageTimes::preprocess_ms);
  table.time("initial_pose_ms", &StageTimes::initial_pose_ms);
  table.time("registration_ms", &StageTimes::registration_ms);
  table.time("map_ms", &StageTimes::map_ms);
  table.time("total_ms", &StageTimes::total_ms);
  return std::move(table.columns);
}

const std::vector<Column>& columns() {
  static const std::vector<Column> kColumns = all_columns();
  return kColumns;
}

template <typename Part>
std::string joined(const Part& part) {
  std::string text;
  for (const Column& column : columns()) text += (text.empty() ? "" : ",") + part(column);
  return text + "\n";
}

}  // namespace

std::string sweeps_csv(const std::vector<SweepResult>& results, const std::vector<std::size_t>& indices) {
  std::string text = joined([](const Column& column) { return column.name; });
  for (std::size_t i = 0; i < results.size(); ++i) {
    const SweepRow row{indices[i], results[i]};
    text += joined([&row](const Column& column) { return column.write(row); });
  }
  return text;
}

SweepTable read_sweeps_csv(const std::filesystem::path& file) {
  CsvFile line(file, kSweepsCsv);
  std::vector<const Column*> read;
  for (const Column& column : columns()) {
    if (column.needed) line.need(column.name);
    if (column.read && line.has(column.name)) read.push_back(&column);
  }
  SweepTable table;
  while (line.next()) {
    SweepRow row;
    for (const Column* column : read) column->read(line, row);
    table.indices.push_back(row.index);
    table.results.push_back(row.result);
  }
  return table;
}

}  // namespace rilo
