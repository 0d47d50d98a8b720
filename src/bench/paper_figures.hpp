// Wang et al., "An Adaptive ICP LiDAR Odometry Based on Reliable Initial Pose" (arXiv 2509.22058): its tables,
// read from experiments/paper/figures.yaml.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rilo {

/// Sequences of Tables I and II, and of Table III.
const std::vector<std::string>& kitti_sequences();
const std::vector<std::string>& m2dgr_sequences();

/// APE in metres: rmse, mean, standard deviation.
using ApeTriple = std::array<double, 3>;

struct PaperApe {
  std::string method;
  std::vector<ApeTriple> sequences;
  ApeTriple average{};  ///< as printed
};

struct PaperRow {
  std::string method;
  std::vector<double> sequences;
  double average = 0;  ///< as printed
};

/// APE on KITTI [m].
const std::vector<PaperApe>& paper_table_1();
/// Time per sweep on KITTI [ms].
const std::vector<PaperRow>& paper_table_2();
/// APE rmse on M2DGR [m].
const std::vector<PaperRow>& paper_table_3();

}  // namespace rilo
