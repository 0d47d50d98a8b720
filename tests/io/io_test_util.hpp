// What the tests of the files share: a folder that goes away, small sweeps, errors looked into.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "io/temporary_folder.hpp"
#include "rilo/cloud/sweep.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::test {

class TempDir {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  std::filesystem::path operator/(std::string_view name) const { return path() / name; }

  /// Writes a file, making its folder when there is none.
  std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    std::filesystem::path file = path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream stream(file, std::ios::binary);
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file;
  }

 private:
  detail::TemporaryFolder folder_{"rilo-io"};
};

inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The bytes of the values as they lie in memory.
template <typename T>
std::string bytes_of(std::initializer_list<T> values) {
  return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}

inline std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

/// `action` must throw IoError whose message has all `parts`.
inline void expect_io_error(const std::function<void()>& action, std::initializer_list<std::string_view> parts) {
  try {
    action();
  } catch (const IoError& error) {
    for (const std::string_view part : parts) {
      EXPECT_NE(std::string_view(error.what()).find(part), std::string_view::npos)
          << "no \"" << part << "\" in: " << error.what();
    }
    return;
  }
  ADD_FAILURE() << "no IoError";
}

/// Hostile bytes: `read` must end well or with an IoError that says something. True when it ended well.
inline bool reads_or_refuses(const std::function<void()>& read) {
  try {
    read();
  } catch (const IoError& error) {
    EXPECT_GT(std::string(error.what()).size(), 20U);
    return false;
  }
  return true;
}

/// `read` must refuse `whole` cut off at every byte, with a message that has all `parts`.
inline void expect_refused_cuts(const std::string& whole, const std::function<void(const std::string&)>& read,
                                std::initializer_list<std::string_view> parts) {
  for (std::size_t size = 0; size < whole.size(); ++size) expect_io_error([&] { read(whole.substr(0, size)); }, parts);
}

/// Cut off in every third `round`, and `turned` bytes turned over.
inline std::string damaged(std::string bytes, int round, int turned, std::mt19937& random) {
  if (round % 3 == 0) bytes.resize(random() % bytes.size());
  for (int k = 0; k < turned && !bytes.empty(); ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
  return bytes;
}

/// Five points with all columns, none of them round in binary.
inline Sweep small_sweep() {
  Sweep sweep;
  sweep.points = {
      {1.1F, -2.2F, 0.3F}, {-40.7F, 12.9F, -1.6F}, {3.3e-5F, 99.9F, 7.7F}, {5, 6, 7}, {-0.1F, -0.2F, -0.3F}};
  sweep.times_s = {0, 0.0251F, 0.0499F, 0.0751F, 0.0999F};
  sweep.intensities = {0, 0.31F, 17.5F, 255, 0.99F};
  sweep.rings = {0, 1, 31, 63, 65535};
  return sweep;
}

/// A cloud file must give back every bit of the sweep that was written.
inline void expect_same(const RawCloud& cloud, const Sweep& sweep, bool with_times_and_rings = true) {
  EXPECT_EQ(cloud.points, sweep.points);
  EXPECT_EQ(cloud.intensities, sweep.intensities);
  if (!with_times_and_rings) return;
  EXPECT_EQ(cloud.rings, sweep.rings);
  ASSERT_TRUE(cloud.times);
  EXPECT_EQ(cloud.times->field, "time");
  EXPECT_EQ(cloud.times->type, ScalarType::kFloat32);
  EXPECT_EQ(cloud.times->floats, std::vector<double>(sweep.times_s.begin(), sweep.times_s.end()));
}

inline void expect_same_sweep(const Sweep& sweep, const Sweep& expected) {
  EXPECT_EQ(sweep.stamp_ns, expected.stamp_ns);
  EXPECT_EQ(sweep.points, expected.points);
  EXPECT_EQ(sweep.times_s, expected.times_s);
  EXPECT_EQ(sweep.intensities, expected.intensities);
  EXPECT_EQ(sweep.rings, expected.rings);
}

/// KITTI's two-point sweep, known by the first point's x.
inline std::string bin_of(float mark) { return bytes_of<float>({mark, 1, 1, 0, 2, 2, 2, 0}); }

/// velodyne/0.bin, 1.bin, … and times.txt unless `times` is empty.
inline void write_sequence(const TempDir& folder, int sweeps, const std::string& times) {
  for (int i = 0; i < sweeps; ++i) {
    folder.write("velodyne/" + std::to_string(i) + ".bin", bin_of(static_cast<float>(i)));
  }
  if (!times.empty()) folder.write("times.txt", times);
}

inline bool has_warning(const SourceInfo& info, const std::string& part) {
  for (const std::string& warning : info.warnings) {
    if (warning.find(part) != std::string::npos) return true;
  }
  return false;
}

inline std::string kitti_row(double x, double y, double z) {
  const auto text = [](double value) { return std::to_string(value); };
  return "1 0 0 " + text(x) + " 0 1 0 " + text(y) + " 0 0 1 " + text(z) + "\n";
}

/// All sweeps that are left.
inline std::vector<Sweep> sweeps_of(ScanSource& source) {
  std::vector<Sweep> sweeps;
  while (auto sweep = source.next()) sweeps.push_back(std::move(*sweep));
  return sweeps;
}

}  // namespace rilo::test
