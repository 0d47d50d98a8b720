// Constant error of a spinning LiDAR's elevation angles.
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geometry/degrees.hpp"
#include "io/sources/source_wrappers.hpp"

namespace rilo::detail {
namespace {

class ElevationCorrectedSource final : public WrappedSource {
 public:
  ElevationCorrectedSource(std::unique_ptr<ScanSource> inner, double offset_deg)
      : WrappedSource(std::move(inner)), offset_deg_(offset_deg) {}

  std::optional<Sweep> next() override {
    std::optional<Sweep> sweep = inner_->next();
    if (sweep) correct_elevation(sweep->points, offset_deg_);
    return sweep;
  }
  SourceInfo info() const override {
    SourceInfo info = inner_->info();
    info.elevation_correction_deg += offset_deg_;
    return info;
  }

 private:
  double offset_deg_;
};

}  // namespace

void correct_elevation(std::vector<Eigen::Vector3f>& points, double offset_deg) {
  const double cosine = std::cos(offset_deg * kRadPerDeg);
  const double sine = std::sin(offset_deg * kRadPerDeg);
  for (Eigen::Vector3f& point : points) {
    const Eigen::Vector3d p = point.cast<double>();
    const double horizontal = std::hypot(p.x(), p.y());
    if (!(horizontal > 0)) continue;  // on the axis, or NaN
    // In the vertical plane through the point: (horizontal, z) rotates by the offset.
    const double shrink = cosine - sine * p.z() / horizontal;
    point = Eigen::Vector3d(p.x() * shrink, p.y() * shrink, cosine * p.z() + sine * horizontal).cast<float>();
  }
}

std::unique_ptr<ScanSource> with_elevation_correction(std::unique_ptr<ScanSource> inner, double offset_deg) {
  constexpr double kLargestDeg = 10;
  if (!(std::abs(offset_deg) <= kLargestDeg)) {
    throw std::invalid_argument("elevation_correction_deg is " + std::to_string(offset_deg) +
                                "; it must be from -10 to 10 (KITTI's HDL-64E: 0.205)");
  }
  return std::make_unique<ElevationCorrectedSource>(std::move(inner), offset_deg);
}

}  // namespace rilo::detail
