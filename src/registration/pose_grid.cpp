#include "registration/pose_grid.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "cloud/fixed_chunks.hpp"
#include "cloud/thinning.hpp"
#include "registration/map_score.hpp"

namespace rilo {

namespace {

constexpr double kNotScored = -1.0;

/// Steps from the centre of the grid.
struct Node {
  int yaw = 0;
  int x = 0;
  int y = 0;
  double score = kNotScored;
};

// A few points rule out most of the nodes; the others are scored again with more points, and so on.
constexpr int kHalfBlock = 1;
constexpr int kBlock = 2 * kHalfBlock + 1;  // nodes along each axis that one of the first round stands for ...
constexpr double kBlockSigmas = 1.5;        // ... with so much more tolerance
constexpr std::size_t kFirstPoints = 40;
constexpr std::size_t kMostPoints = 640;
constexpr std::size_t kMorePoints = 4;       // times as many from round to round ...
constexpr std::size_t kSurvivors = 8;        // ... for an eighth of the nodes, ...
constexpr std::size_t kLeastSurvivors = 50;  // ... but no fewer
constexpr double kVoxelSigmas = 2.0;         // smaller voxels than this tell a search no more

/// Calls use(yaw, x, y) for all steps within so many of none.
template <class Use>
void for_each_step(int yaws, int shifts, const Use& use) {
  for (int yaw = -yaws; yaw <= yaws; ++yaw) {
    for (int x = -shifts; x <= shifts; ++x) {
      for (int y = -shifts; y <= shifts; ++y) {
        use(yaw, x, y);
      }
    }
  }
}

/// The nodes of a grid around its centre.
class Nodes {
 public:
  Nodes(const SE3& centre, const PoseGrid& grid)
      : centre_(centre),
        grid_(grid),
        shifts_(static_cast<int>(std::lround(grid.max_shift_m / grid.shift_step_m))),
        yaws_(static_cast<int>(std::lround(grid.max_yaw_rad / grid.yaw_step_rad))) {}

  /// The middles of the blocks that the grid reaches into, nearest first.
  std::vector<Node> blocks() const {
    const auto blocks = [](int steps) { return (steps + kHalfBlock) / kBlock; };
    const auto nearest = [](int block) { return std::max(kBlock * std::abs(block) - kHalfBlock, 0); };
    std::vector<Node> middles;
    for_each_step(blocks(yaws_), blocks(shifts_), [&](int yaw, int x, int y) {
      if (in_circle(nearest(x), nearest(y))) {
        middles.push_back({kBlock * yaw, kBlock * x, kBlock * y});
      }
    });
    std::stable_sort(middles.begin(), middles.end(),
                     [](const Node& a, const Node& b) { return distance2(a) < distance2(b); });
    return middles;
  }

  /// Within two steps along each axis, the shorter way round.
  bool near_one_another(const Node& a, const Node& b) const {
    const double yaws_apart = std::abs(a.yaw - b.yaw);
    const double all_round = 2.0 * std::numbers::pi / grid_.yaw_step_rad;
    return std::min(yaws_apart, all_round - yaws_apart) <= 2.0 && std::abs(a.x - b.x) <= 2 && std::abs(a.y - b.y) <= 2;
  }

  /// All nodes of some blocks.
  std::vector<Node> within(const std::vector<Node>& middles) const {
    std::vector<Node> nodes;
    for (const Node& middle : middles) {
      for_each_step(kHalfBlock, kHalfBlock, [&](int yaw, int x, int y) {
        const Node node{middle.yaw + yaw, middle.x + x, middle.y + y};
        if (std::abs(node.yaw) <= yaws_ && in_circle(node.x, node.y)) {
          nodes.push_back(node);
        }
      });
    }
    return nodes;
  }

  SE3 pose_of(const Node& node) const {
    SE3 T = SE3::Identity();
    T.linear() = so3_exp(Eigen::Vector3d(0.0, 0.0, node.yaw * grid_.yaw_step_rad));
    T.translation() = grid_.shift_step_m * Eigen::Vector3d(node.x, node.y, 0.0);
    return centre_ * T;
  }

  static int distance2(const Node& n) { return n.yaw * n.yaw + n.x * n.x + n.y * n.y; }

 private:
  bool in_circle(int x, int y) const { return x * x + y * y <= shifts_ * shifts_; }

  SE3 centre_;
  PoseGrid grid_;
  int shifts_;
  int yaws_;
};

void keep_best(std::vector<Node>& nodes) {
  nodes.resize(std::max(nodes.size() / kSurvivors, std::min(nodes.size(), kLeastSurvivors)));
}

/// Scores nodes. What was not scored when time ran out comes last.
class Scorer {
 public:
  Scorer(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const Nodes& grid, const Deadline& deadline)
      : points_(points), map_(map), grid_(grid), deadline_(deadline) {}

  /// Best first; among equal scores the smaller motion wins.
  void sort(std::vector<Node>& nodes, std::size_t points, double sigma_m) const {
    const std::vector<Eigen::Vector3f> picked = evenly_picked(points_, points);
    const std::size_t level = map_.level_of(kVoxelSigmas * sigma_m);
    std::atomic<bool> late = false;
    for_each_index(nodes.size(), [&](std::size_t i) {
      if (late || deadline_.passed()) {
        late = true;
        nodes[i].score = kNotScored;
      } else {
        nodes[i].score = map_score(picked, map_, grid_.pose_of(nodes[i]), sigma_m, level);
      }
    });
    std::stable_sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) {
      return a.score != b.score ? a.score > b.score : Nodes::distance2(a) < Nodes::distance2(b);
    });
  }

  /// Leaves the best few, scored with more points from round to round.
  void narrow(std::vector<Node>& nodes, double sigma_m) const {
    std::size_t points = kFirstPoints;
    sort(nodes, points, sigma_m);
    while (nodes.size() > kLeastSurvivors && points < points_.size() && !deadline_.passed()) {
      keep_best(nodes);
      if (nodes.size() > kLeastSurvivors) {
        points *= kMorePoints;
        sort(nodes, points, sigma_m);
      }
    }
  }

 private:
  const std::vector<Eigen::Vector3f>& points_;
  const LocalMap& map_;
  const Nodes& grid_;
  const Deadline& deadline_;
};

}  // namespace

std::vector<SE3> search_poses(const std::vector<Eigen::Vector3f>& points, const LocalMap& map, const SE3& centre,
                              const PoseGrid& grid, double sigma_m, std::size_t keep, const Deadline& deadline) {
  const Nodes all(centre, grid);
  const Scorer scorer(points, map, all, deadline);
  std::vector<Node> nodes = all.blocks();
  scorer.narrow(nodes, kBlockSigmas * sigma_m);
  if (!deadline.passed()) {
    nodes = all.within(nodes);
    scorer.narrow(nodes, sigma_m);
  }
  if (!deadline.passed()) {
    scorer.sort(nodes, kMostPoints, sigma_m);
  }
  std::vector<Node> chosen;
  for (const Node& node : nodes) {
    if (chosen.size() == keep || node.score == kNotScored) {
      break;
    }
    if (std::none_of(chosen.begin(), chosen.end(), [&](const Node& c) { return all.near_one_another(c, node); })) {
      chosen.push_back(node);
    }
  }
  std::vector<SE3> poses;
  for (const Node& node : chosen) {
    poses.push_back(all.pose_of(node));
  }
  return poses;
}

}  // namespace rilo
