#include "io/folders/kitti_calibration.hpp"

#include "io/file_bytes.hpp"
#include "io/text.hpp"

namespace rilo::detail {

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

std::optional<SE3> calibration_transform(const std::filesystem::path& file) {
  const std::vector<double> r = calibration_row(file, "R:");
  const std::vector<double> t = calibration_row(file, "T:");
  if (r.size() != 9 || t.size() != 3) return std::nullopt;
  SE3 T = SE3::Identity();
  T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
  T.translation() = Eigen::Map<const Eigen::Vector3d>(t.data());
  return T;
}

}  // namespace rilo::detail
