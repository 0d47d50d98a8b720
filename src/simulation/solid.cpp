#include "simulation/solid.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/counter_random.hpp"

namespace rilo::simulation {
namespace {

// The ray in the body's own frame; ranges stay the same.
Ray to_local(const Solid& s, const Ray& ray) {
  const Eigen::Vector3d o = ray.origin - s.centre;
  const Eigen::Vector3d& d = ray.direction;
  return {{s.cos_yaw * o.x() + s.sin_yaw * o.y(), s.cos_yaw * o.y() - s.sin_yaw * o.x(), o.z()},
          {s.cos_yaw * d.x() + s.sin_yaw * d.y(), s.cos_yaw * d.y() - s.sin_yaw * d.x(), d.z()}};
}

struct BoxEntry {
  double range = kInfinity;
  int axis = 0;
};

// Where a ray from outside enters the box |p| <= half; infinite when it does not.
BoxEntry enter_box(const Ray& local, const Eigen::Vector3d& half) {
  double in = -kInfinity;
  double out = kInfinity;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    if (local.direction[i] == 0) {
      if (std::abs(local.origin[i]) > half[i]) return {};
      continue;
    }
    const double inverse = 1 / local.direction[i];
    const double a = (-half[i] - local.origin[i]) * inverse;
    const double b = (half[i] - local.origin[i]) * inverse;
    const double near = std::min(a, b);
    if (near > in) {
      in = near;
      axis = i;
    }
    out = std::min(out, std::max(a, b));
  }
  if (in > out || in <= 0) return {};
  return {in, axis};
}

// A rectangular recess in a face, in metres along it and above its foot.
struct Opening {
  double left = 0, right = 0, bottom = 0, top = 0;
  double depth = 0;  // 0: plain wall
};

Opening opening_at(const Relief& relief, double width, double height, int face, double u, double v) {
  const double bays = std::max(1.0, std::floor(width / relief.bay_m));
  const double bay_m = width / bays;
  const double bay = std::clamp(std::floor(u / bay_m), 0.0, bays - 1);
  const double storey = std::floor(v / relief.storey_m);
  const bool door = storey == 0 && unit(hash(relief.key, face, static_cast<std::int64_t>(bay))) < 0.22;
  const double half_width = (door ? 0.6 : 0.5 * relief.window_share * bay_m);
  const double middle = (bay + 0.5) * bay_m;
  Opening o;
  o.left = middle - half_width;
  o.right = middle + half_width;
  o.bottom = door ? 0.0 : storey * relief.storey_m + relief.sill_m;
  o.top = door ? 2.3 : o.bottom + relief.window_m;
  const bool inside = u > o.left && u < o.right && v > o.bottom && v < o.top && o.top < height - 0.3 && storey >= 0;
  o.depth = inside ? (door ? relief.door_depth_m : relief.window_depth_m) : 0.0;
  return o;
}

// Range at which the coordinate leaves [low, high].
double leave_range(double value, double rate, double low, double high) {
  if (rate == 0) return kInfinity;
  return ((rate > 0 ? high : low) - value) / rate;
}

void cast_house(const Solid& s, const Ray& ray, Hit& hit) {
  const Ray local = to_local(s, ray);
  const BoxEntry entry = enter_box(local, s.half);
  if (!(entry.range < hit.range_m)) return;
  const double cos_angle = std::abs(local.direction[entry.axis]);
  if (entry.axis == 2) return hit.offer(entry.range, cos_angle, s.reflectivity);
  const int along = 1 - entry.axis;
  const Eigen::Vector3d p = local.at(entry.range);
  const double u = p[along] + s.half[along];
  const double v = p.z() + s.half.z() - s.relief.foot_m;
  const int face = 2 * entry.axis + (p[entry.axis] > 0 ? 1 : 0);
  const Opening o = opening_at(s.relief, 2 * s.half[along], 2 * s.half.z() - s.relief.foot_m, face, u, v);
  if (o.depth == 0) return hit.offer(entry.range, cos_angle, s.reflectivity);
  const double to_pane = o.depth / cos_angle;
  const double to_side = leave_range(u, local.direction[along], o.left, o.right);
  const double to_lintel = leave_range(v, local.direction.z(), o.bottom, o.top);
  if (to_pane <= std::min(to_side, to_lintel)) return hit.offer(entry.range + to_pane, cos_angle, 0.12, true);
  const bool side = to_side < to_lintel;
  hit.offer(entry.range + std::min(to_side, to_lintel), std::abs(local.direction[side ? along : 2]), s.reflectivity);
}

void cast_box(const Solid& s, const Ray& ray, Hit& hit) {
  const Ray local = to_local(s, ray);
  const BoxEntry entry = enter_box(local, s.half);
  if (entry.range < hit.range_m) hit.offer(entry.range, std::abs(local.direction[entry.axis]), s.reflectivity, s.glass);
}

void cast_cylinder(const Solid& s, const Ray& ray, Hit& hit) {
  const Eigen::Vector2d o = (ray.origin - s.centre).head<2>();
  const Eigen::Vector2d d = ray.direction.head<2>();
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double radius = s.half.x();
  const double discriminant = b * b - a * (o.squaredNorm() - radius * radius);
  if (a == 0 || discriminant <= 0) return;
  const double range = (-b - std::sqrt(discriminant)) / a;
  if (range <= 0 || range >= hit.range_m) return;
  if (std::abs(ray.origin.z() + range * ray.direction.z() - s.centre.z()) > s.half.z()) return;
  const Eigen::Vector2d normal = (o + range * d) / radius;
  hit.offer(range, std::abs(normal.dot(d)), s.reflectivity);
}

constexpr double kLeafCellM = 0.3;

// The leaf (a small ball) in one cell of a lattice fixed in the world: a tree looks the same from every side, at every
// time. Range to it, infinite when there is none or the ray passes.
double leaf_range(const Solid& s, const Ray& ray, const Eigen::Array3i& cell) {
  const std::uint64_t h = hash(s.key, cell.x(), cell.y(), cell.z());
  if (unit(h) >= s.leaves) return kInfinity;
  RandomStream random(h);
  const double radius = random.uniform(0.05, 0.12);
  Eigen::Vector3d centre;
  for (int i = 0; i < 3; ++i) centre[i] = cell[i] * kLeafCellM + random.uniform(radius, kLeafCellM - radius);
  const Eigen::Vector3d o = ray.origin - centre;
  const double b = o.dot(ray.direction);
  const double discriminant = b * b - o.squaredNorm() + radius * radius;
  return discriminant <= 0 ? kInfinity : -b - std::sqrt(discriminant);
}

// Walks the cells of the lattice from range `in` to `out`.
void cast_leaves(const Solid& s, const Ray& ray, double in, double out, Hit& hit) {
  const Eigen::Vector3d p = ray.at(in);
  Eigen::Array3i cell = (p.array() / kLeafCellM).floor().cast<int>();
  Eigen::Array3d next;
  Eigen::Array3d step;
  for (int i = 0; i < 3; ++i) {
    const double d = ray.direction[i];
    step[i] = d == 0 ? kInfinity : kLeafCellM / std::abs(d);
    next[i] = d == 0 ? kInfinity : in + ((cell[i] + (d > 0 ? 1 : 0)) * kLeafCellM - p[i]) / d;
  }
  for (double range = in; range < out && range < hit.range_m;) {
    const double leaf = leaf_range(s, ray, cell);
    if (leaf < kInfinity) return hit.offer(leaf, 0.7, s.reflectivity);
    int axis = 0;
    range = next.minCoeff(&axis);
    next[axis] += step[axis];
    cell[axis] += ray.direction[axis] > 0 ? 1 : -1;
  }
}

void cast_canopy(const Solid& s, const Ray& ray, Hit& hit) {
  const Eigen::Vector3d o = (ray.origin - s.centre).cwiseQuotient(s.half);
  const Eigen::Vector3d d = ray.direction.cwiseQuotient(s.half);
  const double a = d.squaredNorm();
  const double b = o.dot(d);
  const double discriminant = b * b - a * (o.squaredNorm() - 1);
  if (discriminant <= 0) return;
  const double root = std::sqrt(discriminant);
  const double in = std::max((-b - root) / a, 0.0);
  const double out = (-b + root) / a;
  if (out > 0 && in < hit.range_m) cast_leaves(s, ray, in, out, hit);
}

}  // namespace

Eigen::Vector2d Solid::extent() const {
  if (kind == SolidKind::kCanopy) return half.head<2>();
  const double c = std::abs(cos_yaw);
  const double t = std::abs(sin_yaw);
  return {c * half.x() + t * half.y(), t * half.x() + c * half.y()};
}

Solid make_box(const Eigen::Vector3d& base, const Eigen::Vector3d& size, double yaw_rad, double reflectivity) {
  Solid s;
  s.half = 0.5 * size;
  s.centre = base + Eigen::Vector3d(0, 0, s.half.z());
  s.cos_yaw = std::cos(yaw_rad);
  s.sin_yaw = std::sin(yaw_rad);
  s.reflectivity = reflectivity;
  return s;
}

Solid make_cylinder(const Eigen::Vector3d& base, double radius, double height, double reflectivity) {
  Solid s = make_box(base, {2 * radius, 2 * radius, height}, 0, reflectivity);
  s.kind = SolidKind::kCylinder;
  return s;
}

void cast(const Solid& solid, const Ray& ray, Hit& hit) {
  switch (solid.kind) {
    case SolidKind::kBox:
      return cast_box(solid, ray, hit);
    case SolidKind::kHouse:
      return cast_house(solid, ray, hit);
    case SolidKind::kCylinder:
      return cast_cylinder(solid, ray, hit);
    case SolidKind::kCanopy:
      return cast_canopy(solid, ray, hit);
  }
}

}  // namespace rilo::simulation
