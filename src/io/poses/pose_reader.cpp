#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

constexpr double kRigidTolerance = 1e-3;
constexpr std::size_t kPoseNumbers = 12;
constexpr std::size_t kStampedNumbers = 8;

// Walks through the lines that say something, and says where it is.
class Table {
 public:
  Table(const std::filesystem::path& file, std::string remedy, bool whole_lines_only = false)
      : bytes_(detail::read_file(file)),
        lines_(whole_lines_only ? whole_lines(bytes_.view()) : bytes_.view()),
        remedy_(std::move(remedy)) {}

  /// The next line that is neither blank nor a comment.
  std::optional<std::string_view> next() {
    while (const auto line = lines_.next()) {
      const std::string_view text = detail::trimmed(*line);
      if (!text.empty() && text[0] != '#') return line;
    }
    return std::nullopt;
  }

  /// Exactly N finite numbers, or the first N of more; the first `as_is` words stay text.
  template <std::size_t N>
  std::array<double, N> numbers(std::string_view line, std::size_t as_is = 0, bool more = false) const {
    std::array<double, N> values{};
    detail::WordScanner words(line);
    std::size_t count = 0;
    for (; const auto word = words.next(); ++count) {
      if (count >= N || count < as_is) continue;
      const auto value = detail::parse_double(*word);
      if (!value || !std::isfinite(*value)) fail(words.column(), detail::in_quotes(*word), "a finite number");
      values[count] = *value;
    }
    if (count < N || (count > N && !more)) fail(0, detail::counted(count, "value"), std::to_string(N) + " numbers");
    return values;
  }

  [[noreturn]] void fail(std::size_t column, const std::string& found, const std::string& expected) const {
    const std::size_t line = lines_.number();
    throw IoError(
        {bytes_.path, column == 0 ? detail::at_line(line) : detail::at_line(line, column), found, expected, remedy_});
  }

 private:
  static std::string_view whole_lines(std::string_view text) {
    const std::size_t end = text.rfind('\n');
    return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
  }

  detail::FileBytes bytes_;
  detail::LineScanner lines_;
  std::string remedy_;
};

// Beyond it numbers are of another unit or form, and voxels of a map have no index.
constexpr double kFarthestM = 1e9;

void check_place(const Table& table, const Eigen::Vector3d& t) {
  if (t.norm() > kFarthestM) {
    table.fail(0, "a position " + std::to_string(t.norm()) + " m away", "metres, below 1e9");
  }
}

SE3 to_pose(const Table& table, const std::array<double, kPoseNumbers>& values) {
  SE3 pose = SE3::Identity();
  pose.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = pose.linear();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (off > kRigidTolerance) {
    table.fail(0, "a matrix that is not a rotation (RᵀR is off by " + std::to_string(off) + ")", "a rigid transform");
  }
  if (R.determinant() < 0) table.fail(0, "a reflection (determinant -1)", "a rigid transform");
  check_place(table, pose.translation());
  return pose;
}

StampedPose stamped_pose(const Table& table, std::int64_t stamp_ns, const Eigen::Vector3d& t,
                         const Eigen::Quaterniond& q) {
  if (std::abs(q.norm() - 1) > kRigidTolerance) {
    table.fail(0, "a quaternion of norm " + std::to_string(q.norm()), "norm 1");
  }
  check_place(table, t);
  StampedPose pose;
  pose.stamp_ns = stamp_ns;
  pose.T_odom_lidar.linear() = q.normalized().toRotationMatrix();
  pose.T_odom_lidar.translation() = t;
  return pose;
}

std::vector<SE3> kitti_poses(const std::filesystem::path& file, bool whole_lines_only) {
  Table table(file, "Give a file of poses in KITTI form, one pose of 12 numbers a line", whole_lines_only);
  std::vector<SE3> poses;
  while (const auto line = table.next()) poses.push_back(to_pose(table, table.numbers<kPoseNumbers>(*line)));
  return poses;
}

}  // namespace

std::vector<SE3> read_kitti_poses(const std::filesystem::path& file) { return kitti_poses(file, false); }

std::vector<SE3> read_growing_kitti_poses(const std::filesystem::path& file) { return kitti_poses(file, true); }

Trajectory read_tum(const std::filesystem::path& file) {
  Table table(file, "Give a file of poses in TUM form, t x y z qx qy qz qw a line; 12 numbers a line are KITTI's form");
  Trajectory trajectory;
  while (const auto line = table.next()) {
    const auto values = table.numbers<kStampedNumbers>(*line, 1);
    detail::WordScanner words(*line);
    const std::string_view stamp_text = words.next().value_or("");
    const auto stamp = parse_stamp(stamp_text);
    if (!stamp) table.fail(words.column(), detail::in_quotes(stamp_text), "seconds that fit into 64 bits of ns");
    const Eigen::Quaterniond q(values[7], values[4], values[5], values[6]);
    trajectory.push_back(stamped_pose(table, *stamp, Eigen::Vector3d(values[1], values[2], values[3]), q));
  }
  return trajectory;
}

Trajectory read_euroc(const std::filesystem::path& file) {
  Table table(file, "Give a file of poses in EuRoC form, ns,x,y,z,qw,qx,qy,qz a line");
  Trajectory trajectory;
  while (const auto line = table.next()) {
    std::string spaced(*line);
    std::replace(spaced.begin(), spaced.end(), ',', ' ');
    const auto values = table.numbers<kStampedNumbers>(spaced, 1, true);  // velocities and biases may follow
    detail::WordScanner words(spaced);
    const std::string_view text = words.next().value_or("");
    std::int64_t stamp_ns = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), stamp_ns);
    if (error != std::errc() || end != text.data() + text.size()) {
      table.fail(words.column(), detail::in_quotes(text), "a whole number of ns of 64 bits");
    }
    const Eigen::Quaterniond q(values[4], values[5], values[6], values[7]);
    trajectory.push_back(stamped_pose(table, stamp_ns, Eigen::Vector3d(values[1], values[2], values[3]), q));
  }
  return trajectory;
}

std::optional<SE3> read_kitti_calibration(const std::filesystem::path& file) {
  Table table(file, "Write the line as KITTI does: Tr: and 12 numbers");
  while (const auto line = table.next()) {
    const std::string_view text = detail::trimmed(*line);
    // "Tr_velo_to_cam:" is the same transform in KITTI's object and tracking data.
    for (const std::string_view key : {"Tr:", "Tr_velo_to_cam:"}) {
      if (text.substr(0, key.size()) != key) continue;
      return to_pose(table, table.numbers<kPoseNumbers>(text.substr(key.size())));
    }
  }
  return std::nullopt;
}

std::vector<SE3> camera_to_lidar(const std::vector<SE3>& T_world_cam, const SE3& T_cam_lidar) {
  const SE3 T_lidar_cam = T_cam_lidar.inverse();
  std::vector<SE3> poses;
  poses.reserve(T_world_cam.size());
  for (const SE3& pose : T_world_cam) poses.push_back(T_lidar_cam * pose * T_cam_lidar);
  return poses;
}

}  // namespace rilo
