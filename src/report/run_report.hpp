// What a report shows of one run of the odometry.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "rilo/evaluation/evaluation.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Statistics of one sweep. Times in ms; stage times may stay zero when only the total is known.
struct ReportSweep {
  double total_ms = 0;
  double preprocess_ms = 0;
  double coarse_ms = 0;  ///< coarse registration and choice of the initial pose
  double registration_ms = 0;
  double map_ms = 0;
  int iterations = 0;
  double inlier_ratio = 0;  ///< correspondences per source point
  double sigma_th_m = 0;
  std::string status;        ///< ok, initialising, degenerate, …: as to_string(OdometryStatus) names them
  std::string initial_pose;  ///< identity, prediction or coarse
};

/// Everything about one run. Text may hold any characters; it is escaped.
struct RunReport {
  std::string title;
  std::string name;      ///< short, in legends and tables of a comparison; empty: the title
  std::string sequence;  ///< runs of the same one are compared with each other
  std::string dataset;   ///< path or name of the data
  std::string notice;    ///< shown on top when not empty, e.g. that the run was interrupted
  std::vector<std::pair<std::string, std::string>>
      facts;                        ///< command, configuration, corrections, pose instant, threads …
  std::vector<SE3> estimate;        ///< T_odom_lidar, one per sweep (x forward, y left, z up)
  std::vector<SE3> truth;           ///< empty, or true poses in the same frame (equal first poses); any length
  std::vector<ReportSweep> sweeps;  ///< empty, or one per pose of `estimate`
  std::optional<Evaluation> evaluation;
  /// Figures found before, for what can no longer be computed (the truth is gone): see ComparisonFigure::key.
  std::map<std::string, double> recorded;
  std::vector<Eigen::Vector3f> map_points;  ///< odometry frame (m); empty: no map picture
  double sweep_period_ms = 100;             ///< time between sweeps: what "real time" means
  double peak_rss_mb = 0;                   ///< 0: unknown
};

}  // namespace rilo
