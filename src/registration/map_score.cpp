#include "registration/map_score.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "cloud/fixed_chunks.hpp"

namespace rilo {

namespace {

constexpr double kNotScored = -1.0;

struct Candidate {
  int yaw = 0;
  int x = 0;
  int y = 0;
  double score = kNotScored;
};

// A few points rule out most of the nodes; the others are scored again with more points, and so on.
constexpr std::size_t kFirstPoints = 40;
constexpr std::size_t kMostPoints = 640;
constexpr std::size_t kMorePoints = 4;       // times as many from round to round ...
constexpr std::size_t kSurvivors = 8;        // ... for an eighth of the nodes, ...
constexpr std::size_t kLeastSurvivors = 50;  // ... but no fewer
constexpr double kVoxelSigmas = 2.0;         // smaller voxels than this tell a search no more

constexpr double kBesideM = 1.0;          // far enough that no plane explains the same point there
constexpr double kLittleAgainst = 0.125;  // of the score: in an open field hardly a point tells two places apart
constexpr double kTimesAgainst = 2.0;     // right sweeps hardly ever have less, those in a map of other places about 1

std::vector<Candidate> grid_nodes(const PoseGrid& grid) {
  const int shifts = static_cast<int>(std::lround(grid.max_shift_m / grid.shift_step_m));
  const int yaws = static_cast<int>(std::lround(grid.max_yaw_rad / grid.yaw_step_rad));
  std::vector<Candidate> nodes;
  for (int yaw = -yaws; yaw <= yaws; ++yaw) {
    for (int x = -shifts; x <= shifts; ++x) {
      for (int y = -shifts; y <= shifts; ++y) {
        if (x * x + y * y <= shifts * shifts) {
          nodes.push_back({yaw, x, y});
        }
      }
    }
  }
  return nodes;
}

SE3 pose_of(const Candidate& c, const SE3& centre, const PoseGrid& grid) {
  Vector6d shift = Vector6d::Zero();
  shift[3] = c.x * grid.shift_step_m;
  shift[4] = c.y * grid.shift_step_m;
  SE3 T = SE3::Identity();
  T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, c.yaw * grid.yaw_step_rad));
  T.translation() = shift.tail<3>();
  return centre * T;
}

bool near_one_another(const Candidate& a, const Candidate& b) {
  return std::abs(a.yaw - b.yaw) <= 2 && std::abs(a.x - b.x) <= 2 && std::abs(a.y - b.y) <= 2;
}

/// Calls use(k, term) with the term of the map score of each point k that has a plane.
template <class Use>
void for_each_term(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                   double sigma_m, std::size_t level, const Use& use) {
  const double scale = -0.5 / (sigma_m * sigma_m);
  const auto point_at = [&](std::size_t k) -> Eigen::Vector3d { return T_odom_lidar * points[k].cast<double>(); };
  const auto term = [&](std::size_t k, const Eigen::Vector3d& world, const PlaneSpot& spot) {
    const MapPlane plane = spot.grid->plane_at(spot);
    const double e = plane.normal.dot(world - plane.point);
    use(k, std::exp(scale * e * e));
  };
  map.visit(0, points.size(), point_at, term, level);
}

}  // namespace

double map_score(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                 double sigma_m, std::size_t level) {
  if (points.empty()) {
    return 0.0;
  }
  double sum = 0.0;
  for_each_term(points, map, T_odom_lidar, sigma_m, level, [&](std::size_t, double term) { sum += term; });
  return sum / static_cast<double>(points.size());
}

bool stands_out(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& T_odom_lidar,
                double sigma_m) {
  std::vector<double> here(points.size(), 0.0);
  double score = 0.0;
  for_each_term(points, map, T_odom_lidar, sigma_m, 0, [&](std::size_t k, double term) {
    here[k] = term;
    score += term;
  });
  // Along a road the places in front and behind explain the same points; the sides, which mostly tell, come first.
  const auto over = [&](const Eigen::Vector3d& way) {
    double beside = 0.0;
    double shared = 0.0;
    for_each_term(points, map, T_odom_lidar * Eigen::Translation3d(kBesideM * way), sigma_m, 0,
                  [&](std::size_t k, double term) {
                    beside += term;
                    shared += std::min(term, here[k]);
                  });
    const double against = beside - shared;
    return against <= kLittleAgainst * score || score - shared >= kTimesAgainst * against;
  };
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d front = Eigen::Vector3d::UnitX();
  return over(left) || over(-left) || over(front) || over(-front);
}

std::vector<Eigen::Vector3f> evenly_picked(const std::vector<Eigen::Vector3f>& points, std::size_t count) {
  if (points.size() <= count) {
    return points;
  }
  std::vector<Eigen::Vector3f> picked;
  picked.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    picked.push_back(points[i * points.size() / count]);
  }
  return picked;
}

namespace {

int distance2(const Candidate& c) { return c.yaw * c.yaw + c.x * c.x + c.y * c.y; }

/// Scores the nodes and sorts them, best first; among equal scores the smaller motion wins.
void score_nodes(std::vector<Candidate>& nodes, const std::vector<Eigen::Vector3f>& points, const LocalMap& map,
                 const SE3& centre, const PoseGrid& grid, double sigma_m, const Deadline& deadline) {
  const std::size_t level = map.level_of(kVoxelSigmas * sigma_m);
  std::atomic<bool> late = false;
  for_each_index(nodes.size(), [&](std::size_t i) {
    if (late || deadline.passed()) {
      late = true;
      nodes[i].score = kNotScored;
    } else {
      nodes[i].score = map_score(points, map, pose_of(nodes[i], centre, grid), sigma_m, level);
    }
  });
  std::stable_sort(nodes.begin(), nodes.end(), [&](const Candidate& a, const Candidate& b) {
    return a.score != b.score ? a.score > b.score : distance2(a) < distance2(b);
  });
}

}  // namespace

std::vector<SE3> search_poses(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& centre,
                              const PoseGrid& grid, double sigma_m, std::size_t keep, const Deadline& deadline) {
  std::vector<Candidate> nodes = grid_nodes(grid);
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const Candidate& a, const Candidate& b) { return distance2(a) < distance2(b); });
  const std::size_t most = std::min(points.size(), kMostPoints);
  for (std::size_t count = kFirstPoints;; count *= kMorePoints) {
    score_nodes(nodes, evenly_picked(points, std::min(count, most)), map, centre, grid, sigma_m, deadline);
    if (count >= most || deadline.passed()) {
      break;
    }
    nodes.resize(std::max(nodes.size() / kSurvivors, std::min(nodes.size(), kLeastSurvivors)));
  }
  std::vector<Candidate> chosen;
  for (const Candidate& node : nodes) {
    if (chosen.size() == keep || node.score == kNotScored) {
      break;
    }
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Candidate& c) { return near_one_another(c, node); })) {
      chosen.push_back(node);
    }
  }
  std::vector<SE3> poses;
  for (const Candidate& c : chosen) {
    poses.push_back(pose_of(c, centre, grid));
  }
  return poses;
}

}  // namespace rilo
