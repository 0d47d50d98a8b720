// An experiment's cells as a table of numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/experiment_report.hpp"

namespace rilo {

/// One figure by sequence and configuration.
class ExperimentTable {
 public:
  ExperimentTable(const ExperimentReport& experiment, const std::string& figure);

  const std::vector<std::string>& sequences() const { return sequences_; }            ///< in order of appearance
  const std::vector<std::string>& configurations() const { return configurations_; }  ///< in order of appearance

  /// Nothing where there is no finite number. The last one of repeated cells.
  std::optional<double> at(std::size_t sequence, std::size_t configuration) const {
    return values_[sequence][configuration];
  }

  /// Whether any cell has the figure.
  bool any() const { return any_; }

  /// Sequences for which every configuration has the figure, of those that have it at all: means over others would
  /// not be comparable.
  std::size_t common_sequences() const { return common_; }

  /// Mean over these sequences; nothing without any, or when the configuration never has the figure.
  std::optional<double> mean(std::size_t configuration) const { return means_[configuration]; }

 private:
  void find_common();

  std::vector<std::string> sequences_;
  std::vector<std::string> configurations_;
  std::vector<std::vector<std::optional<double>>> values_;
  std::vector<std::optional<double>> means_;
  bool any_ = false;
  std::size_t common_ = 0;
};

}  // namespace rilo
