#include "rilo/io/map_writer.hpp"

#include <stdexcept>
#include <string>

#include "io/io_test_util.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo {
namespace {

using test::expect_io_error;
using test::TempDir;

RawCloud read_back(const std::filesystem::path& file) {
  return file.extension() == ".ply" ? read_ply(file) : read_pcd(file);
}

TEST(MapWriterTest, StreamedPointsComeBack) {
  const TempDir folder;
  for (const char* name : {"map.ply", "map.pcd"}) {
    for (const bool with_intensity : {false, true}) {
      std::vector<Eigen::Vector3f> all;
      std::vector<float> intensities;
      MapWriter writer(folder / name, with_intensity);
      for (int part = 0; part < 30; ++part) {
        std::vector<Eigen::Vector3f> points;
        for (int i = 0; i < 997; ++i)
          points.emplace_back(static_cast<float>(i) * 0.1F, static_cast<float>(part), -0.3F);
        std::vector<float> values(with_intensity ? points.size() : 0, static_cast<float>(part));
        writer.add(points, values);
        all.insert(all.end(), points.begin(), points.end());
        intensities.insert(intensities.end(), values.begin(), values.end());
      }
      EXPECT_EQ(writer.count(), all.size());
      writer.finish();
      const RawCloud cloud = read_back(folder / name);
      EXPECT_EQ(cloud.points, all);
      EXPECT_EQ(cloud.intensities, intensities);
    }
  }
  EXPECT_EQ(test::files_in(folder.path()), 2U);
}

TEST(MapWriterTest, EmptyMap) {
  const TempDir folder;
  for (const char* name : {"map.ply", "map.PCD"}) {
    write_map(folder / name, {});
    EXPECT_TRUE(name[4] == 'p' ? read_ply(folder / name).points.empty() : read_pcd(folder / name).points.empty());
  }
}

TEST(MapWriterTest, NothingWithoutFinish) {
  const TempDir folder;
  const std::vector<Eigen::Vector3f> points(100'000, Eigen::Vector3f(1, 2, 3));
  {
    MapWriter writer(folder / "map.ply");
    writer.add(points);
    writer.add(points);
  }
  EXPECT_EQ(test::files_in(folder.path()), 0U);
}

TEST(MapWriterTest, Refusals) {
  const TempDir folder;
  expect_io_error([&] { MapWriter(folder / "map.las"); }, {"map.las", "'.las'", ".ply or .pcd"});
  expect_io_error([&] { MapWriter(folder / "none/map.ply"); }, {"does not exist"});
  const std::vector<Eigen::Vector3f> points(2, Eigen::Vector3f(1, 2, 3));
  const std::vector<float> one{1};
  MapWriter with(folder / "a.ply", true);
  EXPECT_THROW(with.add(points), std::invalid_argument);
  EXPECT_THROW(with.add(points, one), std::invalid_argument);
  MapWriter without(folder / "b.ply");
  EXPECT_THROW(without.add(points, std::vector<float>{1, 2}), std::invalid_argument);
}

}  // namespace
}  // namespace rilo
