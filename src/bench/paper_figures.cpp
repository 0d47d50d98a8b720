#include "bench/paper_figures.hpp"

#include <stdexcept>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "bench/paper_figures_text.hpp"

namespace rilo {

namespace {

const YAML::Node& figures() {
  static const YAML::Node kFigures = YAML::Load(kPaperFigures);
  return kFigures;
}

// Every method has a value for each of `names`.
template <typename Row>
std::vector<Row> rows_of(const char* table, std::size_t names) {
  std::vector<Row> rows;
  for (const YAML::Node& node : figures()[table]) {
    Row row;
    row.method = node["method"].as<std::string>();
    row.sequences = node["sequences"].as<decltype(row.sequences)>();
    row.average = node["average"].as<decltype(row.average)>();
    if (row.sequences.size() != names) {
      throw std::logic_error(fmt::format("experiments/paper/figures.yaml, {}, {}: found {} sequences; expected {}",
                                         table, row.method, row.sequences.size(), names));
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

const std::vector<std::string>& kitti_sequences() {
  static const auto kNames = figures()["kitti"].as<std::vector<std::string>>();
  return kNames;
}

const std::vector<std::string>& m2dgr_sequences() {
  static const auto kNames = figures()["m2dgr"].as<std::vector<std::string>>();
  return kNames;
}

const std::vector<PaperApe>& paper_table_1() {
  static const auto kTable = rows_of<PaperApe>("table_1", kitti_sequences().size());
  return kTable;
}

const std::vector<PaperRow>& paper_table_2() {
  static const auto kTable = rows_of<PaperRow>("table_2", kitti_sequences().size());
  return kTable;
}

const std::vector<PaperRow>& paper_table_3() {
  static const auto kTable = rows_of<PaperRow>("table_3", m2dgr_sequences().size());
  return kTable;
}

}  // namespace rilo
