// A few points, coordinate by coordinate: loops over them become vector instructions.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cloud/elevation.hpp"
#include "geometry/pose_derivative.hpp"
#include "rilo/geometry/se3.hpp"

namespace rilo {

/// Points that are worked on together. Functions on a block work on all kSize places; those beyond the points hold
/// other finite numbers.
struct PointBlock {
  static constexpr std::size_t kSize = 64;
  template <typename T>
  using Lanes = std::array<T, kSize>;

  alignas(64) Lanes<float> x{};
  alignas(64) Lanes<float> y{};
  alignas(64) Lanes<float> z{};

  void set(std::size_t i, const Eigen::Vector3f& p) {
    x[i] = p.x();
    y[i] = p.y();
    z[i] = p.z();
  }

  Eigen::Vector3f at(std::size_t i) const { return {x[i], y[i], z[i]}; }

  /// The first n of `points`, at most kSize; zeros beyond them.
  void load(const Eigen::Vector3f* points, std::size_t n) {
    if (n == kSize) {
      load_all(points);
      return;
    }
    for (std::size_t i = 0; i < n; ++i) {
      set(i, points[i]);
    }
    for (std::size_t i = n; i < kSize; ++i) {
      set(i, Eigen::Vector3f::Zero());
    }
  }

  /// kSize points.
  void load_all(const Eigen::Vector3f* points);

  void store(Eigen::Vector3f* points, std::size_t n) const {
    for (std::size_t i = 0; i < n; ++i) {
      points[i] = at(i);
    }
  }
};

/// Where such points lie in another frame.
struct PlaceBlock {
  alignas(64) PointBlock::Lanes<double> x{};
  alignas(64) PointBlock::Lanes<double> y{};
  alignas(64) PointBlock::Lanes<double> z{};

  Eigen::Vector3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Calls use(first, n) for the consecutive blocks of the points first … last − 1.
template <typename Use>
void for_each_block(std::size_t first, std::size_t last, const Use& use) {
  for (; first < last; first += PointBlock::kSize) {
    use(first, std::min(PointBlock::kSize, last - first));
  }
}

/// Whether the squared range lies within [min2, max2] (m²) and the time is one of a sweep: 0 or 1. False for
/// coordinates that are not finite.
void find_in_range(const PointBlock& p, float min2, float max2, const PointBlock::Lanes<float>& times_s,
                   PointBlock::Lanes<int>& in_range);

/// Widens, lane by lane, the spans of the times of the points in range.
void widen_spans(const PointBlock::Lanes<float>& times_s, const PointBlock::Lanes<int>& in_range,
                 PointBlock::Lanes<float>& begins_s, PointBlock::Lanes<float>& ends_s);

/// Tangent of the elevation angle.
void find_tangents(const PointBlock& p, PointBlock::Lanes<float>& tangents);

/// Sum over the pairs of successive points: 1 where the azimuth grows from one to the next, −1 where it falls.
int steps_in_azimuth(const PointBlock& p);

/// Quadrant 0 … 3 of the azimuth, counted from `seam`, a vector in the xy plane; y times `direction` instead of y.
void find_quadrants(const PointBlock& p, const Eigen::Vector2f& seam, float direction,
                    PointBlock::Lanes<int>& quadrants);

/// Adds angles (rad) to the elevation and azimuth of each point, to first order: points move along the tangents. Those
/// on the axis have no elevation.
void turn_beams(PointBlock& p, const PointBlock::Lanes<float>& elevation_rad,
                const PointBlock::Lanes<float>& azimuth_rad);

/// R p of each point.
void rotate(const Eigen::Matrix3f& R, const PointBlock& p, PointBlock& rotated);

/// T p of each point.
void transform(const SE3& T, const PointBlock& p, PlaceBlock& places);

/// Adds derivative.at(place) of each place.
void add_derivatives(const PoseDerivative& derivative, const PlaceBlock& places, PointBlock& to);

/// elevation_jacobian() of each point.
void find_elevation_jacobians(const PointBlock& p, PointBlock& jacobians);

/// `rotation` of each point.
void rotate_elevation(PointBlock& p, const ElevationRotation& rotation);

/// The cell of each point in a grid of polar coordinates. Directions are cut into cells of about `size_rad` by
/// `size_rad` (at least 0.05 rad), numbered below kPolarDirections; layers are as thick as `size_rad` times
/// their range. Any numbers may be given: those of points that are not finite mean nothing.
void find_polar_cells(const PointBlock& p, float size_rad, PointBlock::Lanes<std::uint32_t>& directions,
                      PointBlock::Lanes<std::uint32_t>& layers);

inline constexpr std::uint32_t kPolarDirections = 1U << 15U;

/// The layer of a range (m).
std::uint32_t polar_layer(float range_m, float size_rad);

/// voxel_key(voxel_of(p, inverse_size)) of each point.
void find_voxel_keys(const PointBlock& p, double inverse_size, PointBlock::Lanes<std::uint64_t>& keys);

}  // namespace rilo
