#include "rilo/io/map_writer.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/io_test_util.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::test {
namespace {

RawCloud read_back(const std::filesystem::path& file) {
  return file.extension() == ".ply" ? read_ply(file) : read_pcd(file);
}

// 997 points of one height, with the columns that are asked for.
MapCloud some_points(int part, MapColumns columns) {
  MapCloud cloud;
  for (int i = 0; i < 997; ++i) {
    cloud.points.emplace_back(static_cast<float>(i) * 0.1F, static_cast<float>(part), -0.3F);
    if (columns.normals) cloud.normals.emplace_back(0.0F, i % 2 == 0 ? 1.0F : -1.0F, 0.0F);
    if (columns.intensity) cloud.intensities.push_back(static_cast<float>(part + i));
  }
  return cloud;
}

TEST(MapWriterTest, StreamedPointsComeBack) {
  const TempDir folder;
  for (const char* name : {"map.ply", "map.pcd"}) {
    for (const MapColumns columns :
         {MapColumns{}, MapColumns{false, true}, MapColumns{true, false}, MapColumns{true, true}}) {
      MapCloud all;
      MapWriter writer(folder / name, columns);
      for (int part = 0; part < 30; ++part) {
        const MapCloud points = some_points(part, columns);
        writer.add(points);
        all.points.insert(all.points.end(), points.points.begin(), points.points.end());
        all.intensities.insert(all.intensities.end(), points.intensities.begin(), points.intensities.end());
      }
      EXPECT_EQ(writer.count(), all.points.size());
      writer.finish();
      const RawCloud cloud = read_back(folder / name);
      EXPECT_EQ(cloud.points, all.points);
      EXPECT_EQ(cloud.intensities, all.intensities);
    }
  }
  EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(MapWriterTest, NormalsAsViewersNameThem) {
  const TempDir folder;
  MapCloud map;
  map.points = {{1, 2, 3}};
  map.normals = {{0.25F, 0.5F, -1}};
  map.intensities = {7};
  for (const auto& [name, fields] : {std::pair{"map.ply", "property float nx\nproperty float ny\nproperty float nz\n"},
                                     std::pair{"map.pcd", "FIELDS x y z normal_x normal_y normal_z intensity\n"}}) {
    write_map(folder / name, map);
    const std::string bytes = slurp(folder / name);
    EXPECT_NE(bytes.find(fields), std::string::npos) << bytes;
    std::array<float, 7> row{};
    std::memcpy(row.data(), bytes.data() + bytes.size() - sizeof(row), sizeof(row));
    EXPECT_EQ(row, (std::array<float, 7>{1, 2, 3, 0.25F, 0.5F, -1, 7}));
  }
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
  MapCloud part;
  part.points.assign(100'000, Eigen::Vector3f(1, 2, 3));
  {
    MapWriter writer(folder / "map.ply");
    writer.add(part);
    writer.add(part);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
}

TEST(MapWriterTest, Refusals) {
  const TempDir folder;
  expect_io_error([&] { MapWriter(folder / "map.las"); }, {"map.las", "'.las'", ".ply or .pcd"});
  expect_io_error([&] { MapWriter(folder / "none/map.ply"); }, {"does not exist"});
  MapCloud two;
  two.points.assign(2, Eigen::Vector3f(1, 2, 3));
  MapCloud bright = two;
  bright.intensities = {1, 2};
  MapCloud half = two;
  half.intensities = {1};
  MapWriter with(folder / "a.ply", {false, true});
  EXPECT_THROW(with.add(two), std::invalid_argument);
  EXPECT_THROW(with.add(half), std::invalid_argument);
  EXPECT_NO_THROW(with.add(bright));
  MapWriter without(folder / "b.ply");
  EXPECT_THROW(without.add(bright), std::invalid_argument);
  EXPECT_THROW(MapWriter(folder / "c.ply", {true, false}).add(two), std::invalid_argument);
}

}  // namespace
}  // namespace rilo::test
