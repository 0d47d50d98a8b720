#include "io/folders/kitti_calibration.hpp"

#include <optional>
#include <string>

#include "io/file_bytes.hpp"
#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::detail {
namespace {

// To the digits of KITTI's files. Nothing when it is none: NaN is none, too.
std::optional<Eigen::Matrix3d> rotation_of(const std::vector<double>& rows) {
  constexpr double kMostOff = 1e-3;
  if (rows.size() != 9) return std::nullopt;
  Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!R.allFinite() || off >= kMostOff || R.determinant() < 0) return std::nullopt;
  return R;
}

}  // namespace

std::vector<double> calibration_row(const std::filesystem::path& file, std::string_view key) {
  const FileBytes bytes = read_file(file);
  LineScanner lines(bytes.view());
  std::vector<double> numbers;
  while (const auto line = lines.next()) {
    if (!line->starts_with(key)) continue;
    for (const std::string_view word : words_of(line->substr(key.size()))) {
      const auto number = parse_double(word);
      if (number) numbers.push_back(*number);
    }
    return numbers;
  }
  return numbers;
}

SE3 calibration_transform(const std::filesystem::path& file) {
  const auto R = rotation_of(calibration_row(file, "R:"));
  const std::vector<double> t = calibration_row(file, "T:");
  SE3 T = SE3::Identity();
  if (R && t.size() == 3) {
    T.linear() = *R;
    T.translation() = Eigen::Map<const Eigen::Vector3d>(t.data());
    if (T.translation().allFinite()) return T;
  }
  throw IoError({file, "", "no transform", "R: with the 9 numbers of a rotation and T: with 3", kCalibrationRemedy});
}

Eigen::Matrix3d calibration_rotation(const std::filesystem::path& file, std::string_view key) {
  const auto R = rotation_of(calibration_row(file, key));
  if (R) return *R;
  throw IoError({file, "", "no rotation", std::string(key) + " with the 9 numbers of a rotation", kCalibrationRemedy});
}

}  // namespace rilo::detail
