#include "cloud/point_block.hpp"

#include <bit>
#include <cmath>
#include <numbers>

#include "cloud/measured_point.hpp"
#include "geometry/voxel_key.hpp"
#include "geometry/wide.hpp"

namespace rilo {

namespace {
constexpr std::size_t kSize = PointBlock::kSize;
template <typename T>
using Lanes = PointBlock::Lanes<T>;

/// Tangent of the elevation angle of a point at a horizontal distance; 0 on the axis.
inline float tangent_of(float z, float horizontal) { return horizontal > 0.0F ? z / horizontal : 0.0F; }

inline void find_voxel_indices(const Lanes<float>& from, double inverse_size, Lanes<std::uint32_t>& to) {
  for (std::size_t i = 0; i < kSize; ++i) {
    const double v = static_cast<double>(from[i]) * inverse_size;
    const auto truncated = static_cast<double>(static_cast<int>(v));
    to[i] = static_cast<std::uint32_t>(static_cast<int>(truncated - (v < truncated ? 1.0 : 0.0)));
  }
}

constexpr float kLeastRange2 = 1e-4F;  // m²; what is nearer shares a layer
constexpr float kMostRange2 = 1e12F;   // m²; layers are numbered below 2^10

/// Natural logarithm of the square root, to 0.3 %.
inline float log_of_root(float square) {
  const auto bits = std::bit_cast<std::uint32_t>(square);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23U) - 127);
  const auto m = std::bit_cast<float>((bits & 0x7FFFFFU) | 0x3F800000U);  // 1 … 2
  const float log2 = exponent + (-m * m + 6.0F * m - 5.0F) / 3.0F;        // exact at 1 and 2: steady
  return 0.5F * std::numbers::ln2_v<float> * log2;
}

inline std::uint32_t layer_of(float range2, float inverse_rad) {
  constexpr float kFirst = 5.0F;  // −ln of less than the least range
  const float from_first = log_of_root(range2 > kLeastRange2 ? range2 : kLeastRange2) + kFirst;
  return static_cast<std::uint32_t>(static_cast<int>(from_first * inverse_rad));
}

/// Arcus tangent of −1 … 1, to 0.004.
inline float angle_of(float tangent) {
  return tangent * (0.25F * std::numbers::pi_v<float> + 0.273F * (1.0F - std::abs(tangent)));
}
}  // namespace

RILO_WIDE void PointBlock::load_all(const Eigen::Vector3f* points) {
  const float* from = points->data();
  for (std::size_t i = 0; i < kSize; ++i) {
    x[i] = from[3 * i];
    y[i] = from[3 * i + 1];
    z[i] = from[3 * i + 2];
  }
}

RILO_WIDE void find_in_range(const PointBlock& p, float min2, float max2, const Lanes<float>& times_s,
                             Lanes<int>& in_range) {
  for (std::size_t i = 0; i < kSize; ++i) {
    // A NaN or infinite number makes a comparison false.
    const float range2 = p.x[i] * p.x[i] + (p.y[i] * p.y[i] + p.z[i] * p.z[i]);
    const bool timed = std::abs(times_s[i]) <= detail::kFarthestFromStampS;
    in_range[i] = static_cast<int>(range2 >= min2) & static_cast<int>(range2 <= max2) & static_cast<int>(timed);
  }
}

RILO_WIDE void widen_spans(const Lanes<float>& times_s, const Lanes<int>& in_range, Lanes<float>& begins_s,
                           Lanes<float>& ends_s) {
  for (std::size_t i = 0; i < kSize; ++i) {
    const float begin_s = times_s[i] < begins_s[i] ? times_s[i] : begins_s[i];
    const float end_s = times_s[i] > ends_s[i] ? times_s[i] : ends_s[i];
    begins_s[i] = in_range[i] != 0 ? begin_s : begins_s[i];
    ends_s[i] = in_range[i] != 0 ? end_s : ends_s[i];
  }
}

RILO_WIDE void find_tangents(const PointBlock& p, Lanes<float>& tangents) {
  for (std::size_t i = 0; i < kSize; ++i) {
    tangents[i] = p.z[i] / std::sqrt(p.x[i] * p.x[i] + p.y[i] * p.y[i]);
  }
}

RILO_WIDE int steps_in_azimuth(const PointBlock& p) {
  int steps = 0;
  for (std::size_t i = 1; i < kSize; ++i) {
    const float turned = p.x[i - 1] * p.y[i] - p.y[i - 1] * p.x[i];
    steps += (turned > 0.0F ? 1 : 0) - (turned < 0.0F ? 1 : 0);
  }
  return steps;
}

RILO_WIDE void find_quadrants(const PointBlock& p, const Eigen::Vector2f& seam, float direction,
                              Lanes<int>& quadrants) {
  const float c = seam.x();
  const float s = seam.y();
  for (std::size_t i = 0; i < kSize; ++i) {
    const float y = direction * p.y[i];
    const int behind = c * p.x[i] + s * y < 0.0F ? 1 : 0;
    const int right = c * y - s * p.x[i] < 0.0F ? 1 : 0;
    quadrants[i] = 2 * right + (behind ^ right);
  }
}

RILO_WIDE void turn_beams(PointBlock& p, const Lanes<float>& elevation_rad, const Lanes<float>& azimuth_rad) {
  for (std::size_t i = 0; i < kSize; ++i) {
    const float x = p.x[i];
    const float y = p.y[i];
    const float horizontal = std::sqrt(x * x + y * y);
    const float tangent = tangent_of(p.z[i], horizontal);
    p.x[i] = x + elevation_rad[i] * (-tangent * x) + azimuth_rad[i] * -y;
    p.y[i] = y + elevation_rad[i] * (-tangent * y) + azimuth_rad[i] * x;
    p.z[i] = p.z[i] + elevation_rad[i] * horizontal;
  }
}

RILO_WIDE void rotate(const Eigen::Matrix3f& R, const PointBlock& p, PointBlock& rotated) {
  const std::array<float, 9> r{R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
  for (std::size_t i = 0; i < kSize; ++i) {
    // Eigen's order of the sums.
    rotated.x[i] = r[0] * p.x[i] + (r[1] * p.y[i] + r[2] * p.z[i]);
    rotated.y[i] = r[3] * p.x[i] + (r[4] * p.y[i] + r[5] * p.z[i]);
    rotated.z[i] = r[6] * p.x[i] + (r[7] * p.y[i] + r[8] * p.z[i]);
  }
}

RILO_WIDE void transform(const SE3& T, const PointBlock& p, PlaceBlock& places) {
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m = T.matrix().topRows<3>();
  const double* const r = m.data();
  for (std::size_t i = 0; i < kSize; ++i) {
    const auto x = static_cast<double>(p.x[i]);
    const auto y = static_cast<double>(p.y[i]);
    const auto z = static_cast<double>(p.z[i]);
    places.x[i] = r[0] * x + r[1] * y + r[2] * z + r[3];
    places.y[i] = r[4] * x + r[5] * y + r[6] * z + r[7];
    places.z[i] = r[8] * x + r[9] * y + r[10] * z + r[11];
  }
}

RILO_WIDE void add_derivatives(const PoseDerivative& derivative, const PlaceBlock& places, PointBlock& to) {
  // A copy, which what is written cannot alias. NOLINTNEXTLINE(performance-unnecessary-copy-initialization)
  const PoseDerivative d = derivative;
  for (std::size_t i = 0; i < kSize; ++i) {
    const double x = places.x[i] - d.origin.x();
    const double y = places.y[i] - d.origin.y();
    const double z = places.z[i] - d.origin.z();
    to.x[i] += static_cast<float>(d.translation.x() + (d.rotation.y() * z - d.rotation.z() * y));
    to.y[i] += static_cast<float>(d.translation.y() + (d.rotation.z() * x - d.rotation.x() * z));
    to.z[i] += static_cast<float>(d.translation.z() + (d.rotation.x() * y - d.rotation.y() * x));
  }
}

RILO_WIDE void find_elevation_jacobians(const PointBlock& p, PointBlock& jacobians) {
  for (std::size_t i = 0; i < kSize; ++i) {
    const float horizontal = std::sqrt(p.x[i] * p.x[i] + p.y[i] * p.y[i]);
    const float tangent = tangent_of(p.z[i], horizontal);
    jacobians.x[i] = -tangent * p.x[i];
    jacobians.y[i] = -tangent * p.y[i];
    jacobians.z[i] = horizontal;
  }
}

RILO_WIDE void rotate_elevation(PointBlock& p, const ElevationRotation& rotation) {
  const float cosine = rotation.cosine();
  const float sine = rotation.sine();
  for (std::size_t i = 0; i < kSize; ++i) {
    const float x = p.x[i];
    const float y = p.y[i];
    const float horizontal = std::sqrt(x * x + y * y);
    const float tangent = tangent_of(p.z[i], horizontal);
    p.x[i] = cosine * x + sine * (-tangent * x);
    p.y[i] = cosine * y + sine * (-tangent * y);
    p.z[i] = cosine * p.z[i] + sine * horizontal;
  }
}

RILO_WIDE void find_polar_cells(const PointBlock& p, float size_rad, Lanes<std::uint32_t>& directions,
                                Lanes<std::uint32_t>& layers) {
  const float inverse_rad = 1.0F / size_rad;
  for (std::size_t i = 0; i < kSize; ++i) {
    const float range2 = p.x[i] * p.x[i] + (p.y[i] * p.y[i] + p.z[i] * p.z[i]);
    const bool usual = range2 > 0.0F && range2 <= kMostRange2;  // false for NaN
    const float x = usual ? p.x[i] : 1.0F;
    const float y = usual ? p.y[i] : 0.0F;
    const float z = usual ? p.z[i] : 0.0F;
    // The face of a cube that the direction meets, and where.
    const bool along_x = std::abs(x) >= std::abs(y) && std::abs(x) >= std::abs(z);
    const bool along_y = !along_x && std::abs(y) >= std::abs(z);
    const float depth = along_x ? x : (along_y ? y : z);
    const float across = along_x ? y : x;
    const float up = along_x || along_y ? z : y;
    const float face = (along_x ? 0.0F : (along_y ? 2.0F : 4.0F)) + (depth < 0.0F ? 1.0F : 0.0F);
    const float inverse_depth = 1.0F / std::abs(depth);
    // Faces are 4 rad apart: no cell lies on two of them.
    const int column = static_cast<int>((4.0F * face + 1.0F + angle_of(across * inverse_depth)) * inverse_rad);
    const int row = static_cast<int>((1.0F + angle_of(up * inverse_depth)) * inverse_rad);
    directions[i] = static_cast<std::uint32_t>(column * 64 + row);
    layers[i] = layer_of(usual ? range2 : 1.0F, inverse_rad);
  }
}

std::uint32_t polar_layer(float range_m, float size_rad) { return layer_of(range_m * range_m, 1.0F / size_rad); }

RILO_WIDE void find_voxel_keys(const PointBlock& p, double inverse_size, Lanes<std::uint64_t>& keys) {
  alignas(64) Lanes<std::uint32_t> x;
  alignas(64) Lanes<std::uint32_t> y;
  alignas(64) Lanes<std::uint32_t> z;
  find_voxel_indices(p.x, inverse_size, x);
  find_voxel_indices(p.y, inverse_size, y);
  find_voxel_indices(p.z, inverse_size, z);
  for (std::size_t i = 0; i < kSize; ++i) {
    keys[i] = packed_voxel_key(x[i], y[i], z[i]);
  }
}

}  // namespace rilo
