// Results of a benchmark as tables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/figures.hpp"
#include "bench/text_table.hpp"

namespace rilo {

/// A table with its heading and, below it, what one has to know to read it.
struct TitledTable {
  std::string title;
  TextTable table;
  std::string note;
};

/// "0.1234"; "-" without a value.
std::string shown(const std::optional<double>& value, int digits);

/// Without loss; nothing without a value.
std::string exact(const std::optional<double>& value);

/// Whether tables have columns of time and memory, the only ones that differ from machine to machine.
enum class MeasuredColumns : std::uint8_t { kWith, kWithout };

/// Accuracy and effort of each cell, averages of each configuration, the cells that failed; with several configurations
/// also t_rel and APE by sequence and configuration.
std::vector<TitledTable> bench_tables(const std::vector<BenchCell>& cells,
                                      MeasuredColumns measured = MeasuredColumns::kWith);

/// Differences to an earlier benchmark: new minus old for each cell that both have; cells of only one are named in the
/// note. `baseline`: its results.json.
TitledTable baseline_table(const std::vector<BenchCell>& cells, const nlohmann::json& baseline,
                           const std::filesystem::path& file);

/// Every figure of every cell and of the averages: results.csv.
TextTable bench_csv(const std::vector<BenchCell>& cells, MeasuredColumns measured = MeasuredColumns::kWith);

/// The tables one below the other, for a terminal or as Markdown.
std::string plain_text(const std::vector<TitledTable>& tables);
std::string markdown_text(const std::vector<TitledTable>& tables);

}  // namespace rilo
