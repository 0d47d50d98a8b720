// Wang et al., "An Adaptive ICP LiDAR Odometry Based on Reliable Initial Pose" (arXiv 2509.22058): its tables.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rilo::cli {

/// Sequences of Tables I and II, and of Table III.
constexpr std::array<const char*, 11> kKittiSequences = {"00", "01", "02", "03", "04", "05",
                                                         "06", "07", "08", "09", "10"};
constexpr std::array<const char*, 6> kM2dgrSequences = {"Hall01", "Hall02", "Hall03", "Room01", "Door01", "Lift01"};

/// APE in metres: rmse, mean, standard deviation.
using ApeTriple = std::array<double, 3>;

struct PaperApe {
  std::string method;
  std::vector<ApeTriple> sequences;
  ApeTriple average;  ///< as printed
};

struct PaperRow {
  std::string method;
  std::vector<double> sequences;
  double average;  ///< as printed
};

/// APE on KITTI [m].
const std::vector<PaperApe>& paper_table_1();
/// Time a sweep on KITTI [ms].
const std::vector<PaperRow>& paper_table_2();
/// APE rmse on M2DGR [m].
const std::vector<PaperRow>& paper_table_3();

}  // namespace rilo::cli
