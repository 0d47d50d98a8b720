// What a report shows of an experiment: configurations × sequences, a few figures each.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace rilo {

/// A number that every cell may have; the smaller the better.
struct ExperimentFigure {
  std::string key;    ///< in ExperimentCell::figures
  std::string title;  ///< "APE rmse"
  std::string unit;   ///< "m"; may be empty
  int digits = 3;     ///< behind the point
};

/// One configuration, or another program's poses, on one sequence.
struct ExperimentCell {
  std::string sequence;
  std::string configuration;
  bool peer = false;                      ///< poses of another program
  std::map<std::string, double> figures;  ///< those there are; what is not finite counts as missing
  std::string error;                      ///< why there are none; empty: it succeeded
};

/// Configurations that differ in the value of one key alone.
struct SensitivitySeries {
  std::string key;                                     ///< "coarse.sigma"
  std::vector<std::pair<double, std::string>> points;  ///< value and configuration, ascending
  std::string base;                                    ///< the configuration that the others are measured against
};

/// Everything about one experiment. Text may hold any characters; it is escaped.
struct ExperimentReport {
  std::string title;
  std::string notice;                                      ///< on top when not empty: interrupted, incomplete
  std::vector<std::pair<std::string, std::string>> facts;  ///< command, version …
  std::vector<ExperimentFigure> figures;                   ///< in the order of the choice; the first one is shown
  std::vector<ExperimentCell> cells;
  std::vector<SensitivitySeries> sensitivities;
};

}  // namespace rilo
