#include "bench/paper.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <system_error>

#include <fmt/format.h>

#include "bench/paper_figures.hpp"
#include "io/file_bytes.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

constexpr double kKittiElevationDeg = 0.205;
constexpr double kM2dgrMaxGapS = 0.05;  // its true poses come at 10 to 50 Hz

// A value of each sequence of a table; nothing where there is none.
using Values = std::vector<std::optional<double>>;

struct OurRow {
  std::string name;
  std::vector<BenchCell> cells;  // as given, of one configuration
};

std::vector<OurRow> our_rows(const std::vector<BenchCell>& cells) {
  std::vector<OurRow> rows;
  for (const BenchCell& cell : cells) {
    auto row = std::find_if(rows.begin(), rows.end(), [&](const OurRow& r) { return r.name == cell.configuration; });
    if (row == rows.end()) row = rows.insert(rows.end(), OurRow{cell.configuration, {}});
    row->cells.push_back(cell);
  }
  return rows;
}

// hall_01 and Hall01 are the same.
std::string plain_name(const std::string& name) {
  std::string plain;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) plain += static_cast<char>(std::tolower(byte));
  }
  return plain;
}

template <typename Names>
Values values_of(const OurRow& row, const Names& sequences, const std::string& figure) {
  Values values;
  for (const std::string& name : sequences) {
    const auto cell = std::find_if(row.cells.begin(), row.cells.end(),
                                   [&](const BenchCell& c) { return plain_name(c.sequence) == plain_name(name); });
    values.push_back(cell == row.cells.end() ? std::nullopt : value_of(*cell, bench_figure(figure)));
  }
  return values;
}

// Over the places that `chosen` has too.
std::optional<double> mean_over(const Values& values, const std::vector<bool>& chosen) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!chosen[i]) continue;
    if (!values[i]) return std::nullopt;
    sum += *values[i];
    ++count;
  }
  return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

// Sequences that all our rows have: the only ones over which averages may be compared.
std::vector<bool> common(const std::vector<Values>& rows, std::size_t size) {
  std::vector<bool> chosen(size, !rows.empty());
  for (const Values& row : rows) {
    for (std::size_t i = 0; i < size; ++i) chosen[i] = chosen[i] && row[i].has_value();
  }
  return chosen;
}

std::string counted_average(const std::vector<bool>& chosen) {
  return fmt::format("Avg of our {}", std::count(chosen.begin(), chosen.end(), true));
}

// Tables II and III: one row per method, one column per sequence.
template <typename Names>
TextTable method_table(const std::vector<PaperRow>& paper, const std::vector<OurRow>& ours, const Names& sequences,
                       const std::string& figure, int digits) {
  std::vector<Values> our_values;
  for (const OurRow& row : ours) our_values.push_back(values_of(row, sequences, figure));
  const std::vector<bool> chosen = common(our_values, sequences.size());
  TextTable table;
  table.header = {"method"};
  table.header.insert(table.header.end(), sequences.begin(), sequences.end());
  table.header.insert(table.header.end(), {"Avg", counted_average(chosen)});
  const auto add = [&](const std::string& name, const Values& values, const std::optional<double>& average) {
    std::vector<std::string> row = {name};
    for (const auto& value : values) row.push_back(shown(value, digits));
    row.push_back(shown(average, digits));
    row.push_back(shown(mean_over(values, chosen), digits));
    table.rows.push_back(row);
  };
  const std::vector<bool> all(sequences.size(), true);
  for (const PaperRow& row : paper) add(row.method, Values(row.sequences.begin(), row.sequences.end()), row.average);
  for (std::size_t i = 0; i < ours.size(); ++i) add(ours[i].name, our_values[i], mean_over(our_values[i], all));
  return table;
}

// Columns of Table I: three a method.
struct ApeColumn {
  Values values;
  std::optional<double> average;
};

std::vector<ApeColumn> paper_ape_columns() {
  std::vector<ApeColumn> columns;
  for (const PaperApe& method : paper_table_1()) {
    for (std::size_t k = 0; k < method.average.size(); ++k) {
      ApeColumn column{{}, method.average[k]};
      for (const ApeTriple& ape : method.sequences) column.values.emplace_back(ape[k]);
      columns.push_back(column);
    }
  }
  return columns;
}

TextTable table_1(const std::vector<OurRow>& ours) {
  TextTable table;
  table.header = {"sequence"};
  const auto add_titles = [&](const std::string& name) {
    for (const char* figure : {" RMSE", "Mean", "Std"}) {
      table.header.push_back(figure[0] == ' ' ? name + figure : std::string(figure));
    }
  };
  std::vector<ApeColumn> columns = paper_ape_columns();
  std::vector<Values> our_values;
  for (const PaperApe& method : paper_table_1()) add_titles(method.method);
  const std::vector<bool> all(kitti_sequences().size(), true);
  for (const OurRow& row : ours) {
    add_titles(row.name);
    for (const char* figure : {"ape_rmse_m", "ape_mean_m", "ape_std_m"}) {
      our_values.push_back(values_of(row, kitti_sequences(), figure));
      columns.push_back({our_values.back(), mean_over(our_values.back(), all)});
    }
  }
  for (std::size_t i = 0; i < kitti_sequences().size(); ++i) {
    std::vector<std::string> row = {kitti_sequences()[i]};
    for (const ApeColumn& column : columns) row.push_back(shown(column.values[i], 2));
    table.rows.push_back(row);
  }
  const std::vector<bool> chosen = common(our_values, kitti_sequences().size());
  std::vector<std::string> average = {"Avg"};
  std::vector<std::string> ours_only = {counted_average(chosen)};
  for (const ApeColumn& column : columns) {
    average.push_back(shown(column.average, 2));
    ours_only.push_back(shown(mean_over(column.values, chosen), 2));
  }
  table.rows.push_back(average);
  table.rows.push_back(ours_only);
  return table;
}

// Folders and bags of a data set by name; where both are there, the folder.
std::map<std::string, fs::path> recordings_in(const fs::path& root) {
  std::map<std::string, fs::path> recordings;
  std::error_code error;
  for (fs::directory_iterator entry(root, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    const fs::path& path = entry->path();
    if (entry->is_directory(ignored)) {
      recordings[path.filename().string()] = path;
    } else if (path.extension() == ".bag") {
      recordings.emplace(path.stem().string(), path);
    }
  }
  return recordings;
}

bool in_table_3(const std::string& name) {
  return std::any_of(m2dgr_sequences().begin(), m2dgr_sequences().end(),
                     [&](const std::string& known) { return plain_name(known) == plain_name(name); });
}

}  // namespace

std::vector<BenchJob> kitti_jobs(const fs::path& root, const BenchConfiguration& configuration) {
  std::vector<BenchJob> jobs;
  for (const std::string& name : kitti_sequences()) {
    BenchSequence sequence;
    sequence.name = name;
    sequence.path = root / "sequences" / name;
    if (!detail::is_folder(sequence.path / "velodyne")) continue;
    for (const double degrees : {0.0, kKittiElevationDeg}) {
      BenchJob job{sequence, configuration};
      job.sequence.elevation_correction_deg = degrees;
      job.configuration.name = fmt::format("{}, {}°", configuration.name, degrees);
      job.configuration.config.elevation.enabled = false;
      job.configuration.settings.emplace_back("elevation.enabled=false");
      jobs.push_back(job);
    }
    if (!configuration.config.elevation.enabled) continue;
    BenchJob job{sequence, configuration};
    job.sequence.elevation_correction_deg = 0;
    job.configuration.name = configuration.name + ", own estimate";
    jobs.push_back(job);
  }
  if (jobs.empty()) {
    throw RunError(RunErrorKind::kBadData, root.string() +
                                               ": no sequence found; expected sequences/00/velodyne … "
                                               "sequences/10/velodyne as in the KITTI odometry data set");
  }
  return jobs;
}

std::vector<TitledTable> kitti_tables(const std::vector<BenchCell>& cells, MeasuredColumns measured) {
  const std::vector<OurRow> ours = our_rows(cells);
  const std::string protocol =
      "Ours: 0° and 0.205° are the two protocols of the field, points as recorded and with KITTI's elevation "
      "correction given, both without Rilo's own estimate (elevation.enabled=false); \"own estimate\" gets no "
      "correction and estimates the elevation offset. The paper does not name its protocol.";
  std::vector<TitledTable> tables = {
      {"Table I: APE on KITTI (m)", table_1(ours),
       "Columns of the paper as printed (its Fast-gicp RMSE of 00 and 01 contradict their means and deviations); "
       "\"paper\" is its own method. " +
           protocol},
      {"Table II: time per sweep on KITTI (ms)", method_table(paper_table_2(), ours, kitti_sequences(), "ms_mean", 1),
       "The paper's times are of its own machine; rows and averages as printed (those of DLO and KISS-ICP do not "
       "follow from their rows: 27.9 and 26.7). Ours: mean of all sweeps, reading excluded."}};
  if (measured == MeasuredColumns::kWithout) tables.pop_back();
  return tables;
}

std::vector<BenchJob> m2dgr_jobs(const fs::path& root, const BenchConfiguration& configuration) {
  std::vector<BenchJob> jobs;
  for (const auto& [name, path] : recordings_in(root)) {
    const fs::path truth = root / (name + ".txt");
    if (!detail::is_file(truth) && !in_table_3(name)) continue;
    BenchJob job{{}, configuration};
    job.sequence.name = name;
    job.sequence.path = path;
    job.sequence.ground_truth = truth;
    job.sequence.max_gap_s = kM2dgrMaxGapS;
    jobs.push_back(job);
  }
  if (jobs.empty()) {
    throw RunError(
        RunErrorKind::kBadData,
        root.string() +
            ": no sequence found; expected bags NAME.bag or folders NAME/ with sweeps (.pcd, .ply or .bin with "
            "stamps), and NAME.txt with the true poses (TUM form) beside each");
  }
  return jobs;
}

std::vector<TitledTable> m2dgr_tables(const std::vector<BenchCell>& cells) {
  return {{"Table III: APE on M2DGR, RMSE (m)",
           method_table(paper_table_3(), our_rows(cells), m2dgr_sequences(), "ape_rmse_m", 2),
           "Rows of the paper as printed; \"paper\" is its own method. The true poses are those of the tracked body, "
           "not of the LiDAR: their distance stays in the error where the robot turns."}};
}

}  // namespace rilo
