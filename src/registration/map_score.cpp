#include "registration/map_score.hpp"

#include <algorithm>
#include <cmath>

namespace rilo {

namespace {

constexpr double kBesideM = 1.0;          // far enough that no plane explains the same point there
constexpr double kLittleAgainst = 0.125;  // of the score: in an open field hardly a point tells two places apart
constexpr double kTimesAgainst = 2.0;     // right sweeps hardly ever have less, those in a map of other places about 1

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

}  // namespace rilo
