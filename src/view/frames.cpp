#include "frames.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace rilo::view {

namespace {

static_assert(std::endian::native == std::endian::little, "frames are written as numbers lie in memory");

constexpr std::uint16_t kIntensity = 1;
constexpr std::uint16_t kResidual = 2;
constexpr std::uint16_t kTime = 4;
constexpr float kResidualRangeM = 0.3F;  // what the colour scale spans
constexpr float kInt16 = 32767.0F;

template <typename Number>
void put(Bytes& bytes, Number value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(Number));
  std::memcpy(bytes.data() + at, &value, sizeof(Number));
}

void put_f32(Bytes& bytes, double value) { put(bytes, static_cast<float>(value)); }

Bytes begin_frame(FrameType type, std::uint16_t flags, std::size_t count) {
  const auto low = static_cast<std::uint32_t>(static_cast<std::uint8_t>(type)) |
                   static_cast<std::uint32_t>(kProtocolVersion) << 8U | static_cast<std::uint32_t>(flags) << 16U;
  const std::array<std::uint32_t, 2> header = {low, static_cast<std::uint32_t>(count)};
  Bytes bytes(kHeaderBytes);
  std::memcpy(bytes.data(), header.data(), kHeaderBytes);
  return bytes;
}

Frame done(Bytes bytes) { return std::make_shared<const Bytes>(std::move(bytes)); }

std::uint16_t to_u16(int value) { return static_cast<std::uint16_t>(std::clamp(value, 0, 65535)); }

// xx xy xz yy yz zz
void put_symmetric(Bytes& bytes, const Eigen::Matrix3d& A) {
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) put_f32(bytes, A(row, column));
  }
}

std::uint8_t record_flags(const ViewSweep& sweep) {
  const SweepStats& stats = sweep.result.stats;
  return static_cast<std::uint8_t>((stats.coarse_ran ? 1 : 0) | (stats.converged ? 2 : 0) | (sweep.truth ? 4 : 0) |
                                   (sweep.full_covariance ? 8 : 0));
}

void put_pose(Bytes& bytes, const ViewSweep& sweep) {
  const SE3& T = sweep.result.T_odom_lidar;
  for (int axis = 0; axis < 3; ++axis) put(bytes, T.translation()[axis]);
  const Eigen::Quaterniond q(T.linear());
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) put_f32(bytes, value);
  const Eigen::Vector3d truth = sweep.truth.value_or(Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) put_f32(bytes, truth[axis]);
}

void put_stats(Bytes& bytes, const SweepResult& result) {
  const SweepStats& stats = result.stats;
  put_f32(bytes, stats.sigma_th_m);
  put_f32(bytes, stats.inlier_ratio);
  put(bytes, static_cast<std::uint32_t>(stats.inliers));
  put(bytes, to_u16(stats.iterations));
  put(bytes, to_u16(stats.coarse_iterations));
  put_f32(bytes, stats.residual_rms_m);
  const StageTimes& times = stats.times;
  for (const double ms :
       {times.total_ms, times.preprocess_ms, times.initial_pose_ms, times.registration_ms, times.map_ms}) {
    put_f32(bytes, ms);
  }
  put_f32(bytes, result.twist.tail<3>().norm());
  put_f32(bytes, result.twist.head<3>().norm());
  put_f32(bytes, stats.map_score);
  put_f32(bytes, stats.prediction_score);
  for (const double value : stats.relative_eigenvalues) put_f32(bytes, value);
}

/// Least and largest of the finite values; 0, 0 without any.
std::pair<float, float> span_of(const std::vector<float>& values) {
  float least = std::numeric_limits<float>::max();
  float most = std::numeric_limits<float>::lowest();
  for (const float value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return least <= most ? std::pair(least, most) : std::pair(0.0F, 0.0F);
}

/// Up to the value that one in fifty exceeds: a few reflectors must not leave the rest dark.
std::pair<float, float> usual_span(std::vector<float> values) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return {0.0F, 0.0F};
  const auto upper = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 49 / 50);
  std::nth_element(values.begin(), upper, values.end());
  return {*std::min_element(values.begin(), upper + 1), *upper};
}

/// `least` … `most` as `first` … 255; 0 for what is not finite.
void put_levels(Bytes& bytes, const std::vector<float>& values, float least, float most, float first) {
  const float scale = most > least ? (255.0F - first) / (most - least) : 0.0F;
  for (const float value : values) {
    const float level = std::clamp(first + (value - least) * scale, first, 255.0F);
    bytes.push_back(std::isfinite(value) ? static_cast<std::uint8_t>(level + 0.5F) : std::uint8_t{0});
  }
}

std::int16_t to_i16(float value) { return static_cast<std::int16_t>(std::lround(std::clamp(value, -kInt16, kInt16))); }

void put_position(Bytes& bytes, const Eigen::Vector3f& p, float inverse) {
  for (int axis = 0; axis < 3; ++axis) put(bytes, to_i16(p[axis] * inverse));
}

float scale_for(float largest_m) { return std::max(largest_m, 1.0F) / kInt16; }

}  // namespace

Frame info_frame(std::string_view json) {
  Bytes bytes = begin_frame(FrameType::kInfo, 0, json.size());
  bytes.insert(bytes.end(), json.begin(), json.end());
  return done(std::move(bytes));
}

void append_record(const ViewSweep& sweep, Bytes& records) {
  const SweepResult& result = sweep.result;
  put(records, static_cast<std::uint32_t>(sweep.index));
  put(records, static_cast<std::uint8_t>(result.status));
  put(records, static_cast<std::uint8_t>(result.stats.initial_pose));
  put(records, static_cast<std::uint8_t>(result.stats.initial_pose_reason));
  put(records, record_flags(sweep));
  put(records, result.stamp_ns);
  put_pose(records, sweep);
  put_stats(records, result);
  put_symmetric(records, result.covariance.bottomRightCorner<3, 3>());
  put_symmetric(records, result.translation_evidence);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    put_f32(records, std::sqrt(std::max(0.0, result.covariance(axis, axis))));
  }
  put(records, static_cast<std::uint32_t>(result.stats.points_in));
  put(records, static_cast<std::uint32_t>(result.stats.map_voxels));
}

Frame records_frame(std::uint32_t first, std::span<const std::uint8_t> records) {
  Bytes bytes = begin_frame(FrameType::kRecords, 0, records.size() / kRecordBytes);
  put(bytes, first);
  put(bytes, std::uint32_t{0});
  bytes.insert(bytes.end(), records.begin(), records.end());
  return done(std::move(bytes));
}

Frame map_frame(std::span<const MapPoint> points, double voxel_m, bool begins) {
  Eigen::AlignedBox3f box;
  for (const MapPoint& point : points) box.extend(point.p);
  const Eigen::Vector3f origin = points.empty() ? Eigen::Vector3f::Zero() : Eigen::Vector3f(box.center());
  const float scale = scale_for(points.empty() ? 0.0F : 0.5F * box.sizes().maxCoeff());
  const std::uint32_t first = points.empty() ? 0 : points.front().sweep;
  Bytes bytes = begin_frame(FrameType::kMap, begins ? 1 : 0, points.size());
  for (int axis = 0; axis < 3; ++axis) put(bytes, static_cast<double>(origin[axis]));
  put(bytes, scale);
  put_f32(bytes, voxel_m);
  put(bytes, first);
  put(bytes, std::uint32_t{0});
  for (const MapPoint& point : points) {
    put_position(bytes, point.p - origin, 1.0F / scale);
    put(bytes, static_cast<std::uint16_t>(std::min<std::uint32_t>(point.sweep - first, 65535U)));
  }
  return done(std::move(bytes));
}

Frame sweep_frame(std::uint32_t number, const SweepPoints& sweep) {
  float largest = 0.0F;
  for (const Eigen::Vector3f& p : sweep.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const float scale = scale_for(largest);
  const auto flags =
      static_cast<std::uint16_t>((sweep.intensities.empty() ? 0 : kIntensity) |
                                 (sweep.residuals_m.empty() ? 0 : kResidual) | (sweep.times_s.empty() ? 0 : kTime));
  const auto [intensity_least, intensity_most] = usual_span(sweep.intensities);
  const auto [time_first, time_last] = span_of(sweep.times_s);
  Bytes bytes = begin_frame(FrameType::kSweep, flags, sweep.points.size());
  bytes.reserve(40 + 9 * sweep.points.size());
  put(bytes, number);
  for (const float value : {scale, intensity_least, intensity_most, kResidualRangeM, time_first, time_last}) {
    put(bytes, value);
  }
  put(bytes, std::uint32_t{0});
  for (const Eigen::Vector3f& p : sweep.points) put_position(bytes, p, 1.0F / scale);
  put_levels(bytes, sweep.intensities, intensity_least, intensity_most, 0.0F);
  put_levels(bytes, sweep.residuals_m, 0.0F, kResidualRangeM, 1.0F);  // 0: no plane there
  put_levels(bytes, sweep.times_s, time_first, time_last, 0.0F);
  return done(std::move(bytes));
}

Frame progress_frame(const Progress& progress) {
  Bytes bytes = begin_frame(FrameType::kProgress, progress.finished ? 1 : 0, 0);
  for (const std::uint32_t value : {progress.sweeps, progress.total, progress.dropped, std::uint32_t{0}}) {
    put(bytes, value);
  }
  return done(std::move(bytes));
}

std::optional<Request> parse_request(std::span<const std::uint8_t> message) {
  if (message.size() != kRequestBytes || message[1] != kProtocolVersion || message[2] != 0 || message[3] != 0) {
    return std::nullopt;
  }
  Request request;
  std::memcpy(&request.value, message.data() + 4, sizeof(request.value));
  switch (message[0]) {
    case static_cast<std::uint8_t>(Request::Kind::kSweep):
      request.kind = Request::Kind::kSweep;
      return request;
    case static_cast<std::uint8_t>(Request::Kind::kFollow):
      request.kind = Request::Kind::kFollow;
      if (request.value > 1) return std::nullopt;
      return request;
    default:
      return std::nullopt;
  }
}

}  // namespace rilo::view
