// Per-point times from the order of the points.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cloud/measured_point.hpp"
#include "cloud/sensor_axis.hpp"
#include "rilo/io/point_times.hpp"

namespace rilo {
namespace {

constexpr std::size_t kBlocks = 128;        // a sweep's points, in which the sensor turns by a few degrees
constexpr std::size_t kLeastInBlock = 8;    // points
constexpr double kOneWay = 0.95;            // share of the steps from block to block in the same direction
constexpr double kLeastSwept = 60.0 / 360;  // revolutions: a window of that width is swept in order, too
constexpr double kMostSwept = 450.0 / 360;  // messages of a constant number of packets hold up to 400°

/// Where the middle of a block lies among the points, and how far the sensor had turned by then.
struct Turn {
  double index = 0;
  double revolutions = 0;  // since the first block
};
using Turns = std::array<Turn, kBlocks>;

/// Nothing when there are too few points.
std::optional<Turns> turns_of(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::size_t> measured;
  measured.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (detail::is_measured(points[i]) && !detail::is_near_axis(points[i])) measured.push_back(i);
  }
  if (measured.size() < kBlocks * kLeastInBlock) return std::nullopt;
  Turns turns;
  double azimuth_before = 0;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    const std::size_t begin = b * measured.size() / kBlocks;
    const std::size_t end = (b + 1) * measured.size() / kBlocks;
    Eigen::Vector2d direction = Eigen::Vector2d::Zero();
    double index = 0;
    for (std::size_t k = begin; k < end; ++k) {
      direction += points[measured[k]].head<2>().cast<double>().normalized();
      index += static_cast<double>(measured[k]);
    }
    const double azimuth = std::atan2(direction.y(), direction.x());
    turns[b].index = index / static_cast<double>(end - begin);
    if (b > 0) {
      const double step = std::remainder(azimuth - azimuth_before, 2 * std::numbers::pi);
      turns[b].revolutions = turns[b - 1].revolutions + step / (2 * std::numbers::pi);
    }
    azimuth_before = azimuth;
  }
  return turns;
}

bool one_way(const Turns& turns) {
  std::size_t same = 0;
  for (std::size_t b = 1; b < kBlocks; ++b) {
    same += (turns[b].revolutions - turns[b - 1].revolutions) * turns.back().revolutions > 0 ? 1 : 0;
  }
  const double swept = std::abs(turns.back().revolutions);
  return static_cast<double>(same) >= kOneWay * (kBlocks - 1) && swept >= kLeastSwept && swept <= kMostSwept;
}

/// How far the sensor had turned at each point; before the first block and after the last as in them.
std::vector<double> turned_at_points(const Turns& turns, std::size_t points) {
  std::vector<double> turned(points);
  std::size_t block = 0;
  for (std::size_t i = 0; i < points; ++i) {
    const auto index = static_cast<double>(i);
    while (block + 2 < kBlocks && index >= turns[block + 1].index) ++block;
    const Turn& a = turns[block];
    const Turn& b = turns[block + 1];
    turned[i] = a.revolutions + (index - a.index) / (b.index - a.index) * (b.revolutions - a.revolutions);
  }
  return turned;
}

}  // namespace

std::optional<std::vector<float>> order_times(const std::vector<Eigen::Vector3f>& points, double period_s) {
  const std::optional<Turns> turns = turns_of(points);
  if (!turns || !one_way(*turns)) return std::nullopt;
  const std::vector<double> turned = turned_at_points(*turns, points.size());
  const double swept = turned.back() - turned.front();
  std::vector<float> times(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    times[i] = static_cast<float>(period_s * std::clamp((turned[i] - turned.front()) / swept, 0.0, 1.0));
  }
  return times;
}

}  // namespace rilo
