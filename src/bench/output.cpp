#include "bench/output.hpp"

#include "bench/cell_file.hpp"
#include "bench/paired.hpp"
#include "bench/paper.hpp"
#include "console/text.hpp"
#include "io/atomic_file.hpp"
#include "io/file_bytes.hpp"
#include "results/output_check.hpp"
#include "results/run_outputs.hpp"

namespace rilo {

namespace {

constexpr const char* kResultsJson = "results.json";
constexpr const char* kResultsCsv = "results.csv";
constexpr const char* kPairedCsv = "paired.csv";
constexpr const char* kResultsMd = "results.md";

std::vector<TitledTable> paper_tables(const BenchOutput& output, MeasuredColumns measured) {
  std::vector<TitledTable> tables;
  if (output.tables == PaperTables::kKitti) tables = kitti_tables(output.bench.cells, measured);
  if (output.tables == PaperTables::kM2dgr) tables = m2dgr_tables(output.bench.cells);
  if (output.bench.count == 0) return tables;
  const std::string part = "the first " + counted(output.bench.count, "sweep") + " of each sequence";
  for (TitledTable& table : tables) {
    table.title += "; ours: " + part;
    table.note = "Not to be compared: the paper's figures are of whole sequences, ours of " + part + ". " + table.note;
  }
  return tables;
}

}  // namespace

BenchOutput bench_output(const BenchStore& store) {
  std::vector<BenchCell> cells;
  cells.reserve(store.cells.size());
  for (const StoredCell& stored : store.cells) cells.push_back(stored.cell);
  BenchOutput output{store.bench, store.tables, nullptr, {}};
  output.bench.cells = combined(cells);
  return output;
}

std::vector<TitledTable> all_tables(const BenchOutput& output, MeasuredColumns measured) {
  std::vector<TitledTable> tables = bench_tables(output.bench.cells, measured);
  const auto paired = paired_tables(output.bench.cells);
  tables.insert(tables.end(), paired.begin(), paired.end());
  const auto paper = paper_tables(output, measured);
  tables.insert(tables.end(), paper.begin(), paper.end());
  if (!output.baseline.is_null()) {
    tables.push_back(baseline_table(output.bench.cells, output.baseline, output.baseline_file));
  }
  return tables;
}

std::string bench_markdown(const BenchOutput& output, MeasuredColumns measured) {
  return "# " + output.bench.command_line + "\n\n" + markdown_text(all_tables(output, measured));
}

void check_results_folder(const std::filesystem::path& folder) {
  const std::filesystem::path store = folder / kStoreName;
  if (detail::is_folder(folder / kCells)) return;
  if (detail::is_file(store)) {  // the cells were deleted, so that all are run again
    check_replaced(store, "TABLE cells", "store of a benchmark", "--out");
    return;
  }
  for (const char* name : {kResultsJson, kResultsCsv, kPairedCsv, kResultsMd}) {
    if (detail::path_exists(folder / name)) {
      throw RunError(RunErrorKind::kCannotWrite,
                     (folder / name).string() +
                         ": would be replaced, and no benchmark has left it; choose another --out, or move the file");
    }
  }
}

void write_results(const std::filesystem::path& folder, const BenchOutput& output, const BenchStore& store) {
  guard_writing([&] {
    write_atomically(folder / kResultsJson, json_text(results_json(output.bench)));
    write_atomically(folder / kResultsCsv, bench_csv(output.bench.cells).csv());
    const TextTable paired = paired_csv(output.bench.cells);
    if (paired.rows.empty()) {
      std::filesystem::remove(folder / kPairedCsv);  // of a plan that had peers
    } else {
      write_atomically(folder / kPairedCsv, paired.csv());
    }
    write_atomically(folder / kResultsMd, bench_markdown(output));
    write_store(folder / kStoreName, store);
  });
}

}  // namespace rilo
