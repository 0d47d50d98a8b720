// What a report shows of one run of the odometry.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "rilo/evaluation/evaluation.hpp"
#include "rilo/geometry/se3.hpp"
#include "rilo/odometry/sweep_result.hpp"

namespace rilo {

/// Everything about one run. Text may hold any characters; it is escaped.
struct RunReport {
  std::string title;
  std::string name;      ///< short, in legends and tables of a comparison; empty: the title
  std::string sequence;  ///< runs of the same one are compared with each other
  std::string dataset;   ///< path or name of the data
  std::string notice;    ///< shown on top when not empty, e.g. that the run was interrupted
  std::vector<std::pair<std::string, std::string>>
      facts;                         ///< command, configuration, corrections, pose instant, threads …
  std::vector<SE3> estimate;         ///< T_odom_lidar, one per sweep (x forward, y left, z up)
  std::vector<SE3> truth;            ///< empty, or true poses in the same frame (equal first poses); any length
  std::vector<SweepResult> sweeps;   ///< empty, or one per pose of `estimate`; only their statistics are shown
  std::vector<std::size_t> numbers;  ///< empty: from 0 on, or the places of the poses of `estimate` in the data
  std::optional<Evaluation> evaluation;
  /// Figures found before, for what can no longer be computed (the truth is gone): see ComparisonFigure::key.
  std::map<std::string, double> recorded;
  std::vector<Eigen::Vector3f> map_points;  ///< odometry frame (m); empty: no map picture
  double sweep_period_ms = 100;             ///< time between sweeps: what "real time" means
  double peak_rss_mb = 0;                   ///< 0: unknown
};

}  // namespace rilo
