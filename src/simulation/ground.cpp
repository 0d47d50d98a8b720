#include "simulation/ground.hpp"

#include <algorithm>
#include <cmath>

namespace rilo::simulation {
namespace {

constexpr double kRasterM = 0.5;
constexpr double kCloseM = 1e-3;  // a ray this little above a surface has met it
constexpr int kMostSteps = 200;
constexpr double kRoadReflectivity = 0.2;
constexpr double kPavementReflectivity = 0.32;
constexpr double kMarkingReflectivity = 0.75;

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double s = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - s * along).norm();
}

// Dashed line in the middle of the street, and the line that parking places begin at.
double road_reflectivity(const Eigen::Vector3d& p, double street_m) {
  const bool dash = std::abs(street_m) < 0.12 && std::fmod(std::abs(p.x() + p.y()), 6.0) < 3.0;
  const bool edge = std::abs(street_m - 3.5) < 0.08;
  return dash || edge ? kMarkingReflectivity : kRoadReflectivity;
}

}  // namespace

Ground::Ground(const Terrain& terrain, const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& centre_lines,
               const Eigen::Vector2d& low, const Eigen::Vector2d& high)
    : low_(low), high_(high) {
  columns_ = static_cast<std::size_t>(std::ceil((high.x() - low.x()) / kRasterM)) + 1;
  rows_ = static_cast<std::size_t>(std::ceil((high.y() - low.y()) / kRasterM)) + 1;
  raster_.reserve(columns_ * rows_);
  for (std::size_t r = 0; r < rows_; ++r) {
    for (std::size_t c = 0; c < columns_; ++c) {
      const Eigen::Vector2d p = low + kRasterM * Eigen::Vector2d(static_cast<double>(c), static_cast<double>(r));
      raster_.push_back({static_cast<float>(terrain.height(p)), static_cast<float>(kFarFromStreetM)});
    }
  }
  for (const auto& [begin, end] : centre_lines) measure_street(begin, end);
  measure_slope();
}

void Ground::measure_street(const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kFarFromStreetM);
  const Eigen::Vector2d first = ((begin.cwiseMin(end) - reach - low_) / kRasterM).cwiseMax(0);
  const Eigen::Vector2d last = (begin.cwiseMax(end) + reach - low_) / kRasterM;
  const auto last_column = static_cast<std::size_t>(std::clamp(last.x(), 0.0, static_cast<double>(columns_ - 1)));
  const auto last_row = static_cast<std::size_t>(std::clamp(last.y(), 0.0, static_cast<double>(rows_ - 1)));
  for (auto r = static_cast<std::size_t>(first.y()); r <= last_row; ++r) {
    for (auto c = static_cast<std::size_t>(first.x()); c <= last_column; ++c) {
      const Eigen::Vector2d p = low_ + kRasterM * Eigen::Vector2d(static_cast<double>(c), static_cast<double>(r));
      float& street = raster_[r * columns_ + c].street;
      street = std::min(street, static_cast<float>(distance_to_segment(p, begin, end)));
    }
  }
}

void Ground::measure_slope() {
  for (std::size_t r = 0; r + 1 < rows_; ++r) {
    for (std::size_t c = 0; c + 1 < columns_; ++c) {
      const float here = raster_[r * columns_ + c].terrain;
      const double dx = static_cast<double>(raster_[r * columns_ + c + 1].terrain - here) / kRasterM;
      const double dy = static_cast<double>(raster_[(r + 1) * columns_ + c].terrain - here) / kRasterM;
      steepest_ = std::max(steepest_, std::hypot(dx, dy));
    }
  }
  steepest_ = 1.1 * steepest_ + 1e-3;  // differences along the axes miss a little of the slope between
}

bool Ground::contains(const Eigen::Vector2d& p) const {
  return (p.array() >= low_.array()).all() && (p.array() < high_.array()).all();
}

// Bilinear between the raster's points.
Ground::Place Ground::place(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d g = (p - low_) / kRasterM;
  const auto c = static_cast<std::size_t>(g.x());
  const auto r = static_cast<std::size_t>(g.y());
  const double x = g.x() - static_cast<double>(c);
  const double y = g.y() - static_cast<double>(r);
  const Sample* s = &raster_[r * columns_ + c];
  const Sample* t = s + columns_;
  const auto blend = [x, y](double a, double b, double e, double f) {
    return (1 - y) * ((1 - x) * a + x * b) + y * ((1 - x) * e + x * f);
  };
  return {blend(s[0].terrain, s[1].terrain, t[0].terrain, t[1].terrain),
          blend(s[0].street, s[1].street, t[0].street, t[1].street)};
}

double Ground::road_height(const Place& place) {
  const double side = std::min(place.street / kKerbM, 1.0);
  return place.terrain - kGutterM * side * side;
}

double Ground::street_distance(const Eigen::Vector2d& p) const {
  return contains(p) ? place(p).street : kFarFromStreetM;
}

double Ground::height(const Eigen::Vector2d& p) const {
  const Place at = place(p.cwiseMax(low_).cwiseMin(high_ - Eigen::Vector2d::Constant(1e-6)));
  return at.street > kKerbM ? at.terrain + kRaisedM : road_height(at);
}

// Down to the level of the pavements by steps that cannot go through it; a road lies below that level.
void Ground::cast(const Ray& ray, Hit& hit) const {
  const double closing = steepest_ * ray.direction.head<2>().norm() - ray.direction.z();
  if (closing <= 0) return;
  double range = 0;
  for (int step = 0; step < kMostSteps && range < hit.range_m; ++step) {
    const Eigen::Vector3d p = ray.at(range);
    if (!contains(p.head<2>())) return;
    const Place at = place(p.head<2>());
    const double above = p.z() - at.terrain - kRaisedM;
    if (above > kCloseM) {
      range += above / closing;
      continue;
    }
    if (at.street <= kKerbM) return cast_on_road(ray, range, hit.range_m, hit);
    hit.offer(range + above / closing, std::abs(ray.direction.z()), kPavementReflectivity);
    return;
  }
}

void Ground::cast_on_road(const Ray& ray, double start, double limit, Hit& hit) const {
  const double slope = steepest_ + 2 * kGutterM / kKerbM;
  const double closing = slope * ray.direction.head<2>().norm() - ray.direction.z();
  if (closing <= 0) return;
  double before = start;
  double range = start;
  for (int step = 0; step < kMostSteps && range < limit; ++step) {
    const Eigen::Vector3d p = ray.at(range);
    if (!contains(p.head<2>())) return;
    const Place at = place(p.head<2>());
    if (at.street > kKerbM) {  // below the pavement: through the face of the kerb
      for (int halving = 0; halving < 12; ++halving) {
        const double middle = 0.5 * (before + range);
        const Eigen::Vector2d q = ray.at(middle).head<2>();
        (place(q).street > kKerbM ? range : before) = middle;
      }
      hit.offer(range, 0.7, kPavementReflectivity);
      return;
    }
    const double above = p.z() - road_height(at);
    if (above <= kCloseM) {
      hit.offer(range + above / closing, std::abs(ray.direction.z()), road_reflectivity(p, at.street));
      return;
    }
    before = range;
    range += above / closing;
  }
}

}  // namespace rilo::simulation
