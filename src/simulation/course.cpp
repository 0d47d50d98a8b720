#include "simulation/course.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace rilo::simulation {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Corner {
  Eigen::Vector2d in, out, point;  // unit directions before and after
  double radius = 0, angle = 0;    // signed turn
  double tangent() const { return radius * std::tan(std::abs(angle) / 2); }
};

Corner corner_at(std::size_t i) {
  const auto& corners = course_corners();
  const std::size_t n = corners.size();
  Corner c;
  c.point = corners[i].point;
  c.in = (c.point - corners[(i + n - 1) % n].point).normalized();
  c.out = (corners[(i + 1) % n].point - c.point).normalized();
  c.radius = corners[i].radius_m;
  c.angle = std::atan2(cross(c.in, c.out), c.in.dot(c.out));
  return c;
}

// Point `s` metres into the arc that rounds the corner.
Eigen::Vector2d on_arc(const Corner& c, double s) {
  const double side = c.angle > 0 ? 1.0 : -1.0;
  const double turned = s / c.radius;
  const Eigen::Vector2d start = c.point - c.tangent() * c.in;
  const Eigen::Vector2d normal = side * left_of(c.in);
  return start + c.radius * (std::sin(turned) * c.in + (1.0 - std::cos(turned)) * normal);
}

// One leg: the straight piece up to a corner, then its arc.
struct Piece {
  Eigen::Vector2d begin;
  Corner corner;
  double straight = 0, arc = 0;
};

std::vector<Piece> pieces() {
  const std::size_t n = course_corners().size();
  std::vector<Piece> result;
  for (std::size_t i = 0; i < n; ++i) {
    const Corner before = corner_at((i + n - 1) % n);
    const Corner c = corner_at(i);
    Piece p;
    p.corner = c;
    p.begin = before.point + before.tangent() * before.out;
    p.straight = (c.point - p.begin).dot(c.in) - c.tangent();
    p.arc = std::abs(c.angle) * c.radius;
    result.push_back(p);
  }
  // Time 0 is in the middle of the first straight, not at the end of an arc.
  std::rotate(result.begin(), result.begin() + 1, result.end());
  return result;
}

Eigen::Vector2d point_at(const std::vector<Piece>& all, double s) {
  for (const Piece& p : all) {
    if (s < p.straight) return p.begin + s * p.corner.in;
    s -= p.straight;
    if (s < p.arc) return on_arc(p.corner, s);
    s -= p.arc;
  }
  return all.front().begin;
}

}  // namespace

const std::vector<CourseCorner>& course_corners() {
  static const std::vector<CourseCorner> kCorners = {
      {{0, 0}, 11},   {{92, 0}, 11}, {{92, 38}, 11}, {{51, 38}, 11},
      {{51, 74}, 11}, {{0, 74}, 11}, {{-1, 50}, 90}, {{-1, 26}, 90},
  };
  return kCorners;
}

std::vector<Eigen::Vector2d> rounded_course(double spacing_m) {
  const std::vector<Piece> all = pieces();
  double length = 0;
  for (const Piece& p : all) length += p.straight + p.arc;
  const auto count = static_cast<std::size_t>(std::lround(length / spacing_m));
  const double start = 0.25 * all.front().straight;
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = start + length * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(point_at(all, s < length ? s : s - length));
  }
  return points;
}

std::vector<StreetLeg> street_legs() {
  constexpr double kSideStreetM = 58;
  const auto& corners = course_corners();
  const std::size_t n = corners.size();
  std::vector<StreetLeg> legs;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d a = corners[i].point;
    const Eigen::Vector2d b = corners[(i + 1) % n].point;
    const Eigen::Vector2d shift = kLaneOffsetM * left_of((b - a).normalized());
    legs.push_back({a + shift, b + shift, false});
  }
  // At each sharp left turn the street that one comes along goes on; the right turn would lead into the block.
  for (std::size_t i = 0; i < n; ++i) {
    const Corner c = corner_at(i);
    if (c.angle < std::numbers::pi / 4) continue;
    const Eigen::Vector2d begin = c.point + kLaneOffsetM * left_of(c.in);
    legs.push_back({begin, begin + kSideStreetM * c.in, true});
  }
  return legs;
}

}  // namespace rilo::simulation
