// Files cut off at every byte, bytes turned over, and bytes that are nothing at all: an IoError or a cloud, never more.
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/cloud_reader.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo::test {
namespace {

using Read = std::function<std::size_t(const std::filesystem::path&)>;  // number of points or poses

struct Example {
  std::string name;
  bool text;
  std::function<void(const std::filesystem::path&)> write;
  Read read;
};

std::size_t points_of(const RawCloud& cloud) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == cloud.points.size(); };
  EXPECT_TRUE(fits(cloud.intensities.size()) && fits(cloud.rings.size()));
  EXPECT_TRUE(!cloud.times || cloud.times->size() == cloud.points.size());
  return cloud.points.size();
}

std::vector<Example> examples() {
  const Read bin = [](const auto& file) { return points_of(read_bin(file)); };
  const Read pcd = [](const auto& file) { return points_of(read_pcd(file)); };
  const Read ply = [](const auto& file) { return points_of(read_ply(file)); };
  std::vector<Example> all{{"bin", false, [](const auto& f) { write_kitti_bin(f, small_sweep()); }, bin}};
  for (const auto encoding : {PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed}) {
    all.push_back({"pcd" + std::to_string(static_cast<int>(encoding)), encoding == PcdEncoding::kAscii,
                   [=](const auto& f) { write_pcd(f, small_sweep(), encoding); }, pcd});
  }
  for (const auto encoding : {PlyEncoding::kAscii, PlyEncoding::kBinaryLittleEndian, PlyEncoding::kBinaryBigEndian}) {
    all.push_back({"ply" + std::to_string(static_cast<int>(encoding)), encoding == PlyEncoding::kAscii,
                   [=](const auto& f) { write_ply(f, small_sweep(), encoding); }, ply});
  }
  all.push_back({"kitti_poses", true,
                 [](const auto& f) { std::ofstream(f) << kitti_row(1, 2, 3) << kitti_row(4, 5, 6); },
                 [](const auto& f) { return read_kitti_poses(f).size(); }});
  all.push_back({"tum", true, [](const auto& f) { std::ofstream(f) << "1.5 1 2 3 0 0 0 1\n1.6 1 2 3 0 0 0 1\n"; },
                 [](const auto& f) { return read_tum(f).size(); }});
  all.push_back({"euroc", true, [](const auto& f) { std::ofstream(f) << "15,1,2,3,1,0,0,0\n16,1,2,3,1,0,0,0\n"; },
                 [](const auto& f) { return read_euroc(f).size(); }});
  all.push_back({"stamps", true, [](const auto& f) { std::ofstream(f) << "0.0\n1.0e-01\n2.0e-01\n"; },
                 [](const auto& f) { return read_stamps(f).size(); }});
  all.push_back({"calib", true, [](const auto& f) { std::ofstream(f) << "P0: 1 2\nTr: 1 0 0 0 0 1 0 0 0 0 1 0\n"; },
                 [](const auto& f) { return read_kitti_calibration(f) ? 1U : 0U; }});
  return all;
}

class HostileBytesTest : public testing::TestWithParam<Example> {
 protected:
  void SetUp() override { GetParam().write(folder / "whole"); }

  bool try_read(const std::string& bytes) const {
    // Nothing out of nothing: an item takes a byte at least.
    const auto file = folder.write("hostile", bytes);
    return reads_or_refuses([&] { EXPECT_LE(GetParam().read(file), bytes.size()); });
  }

  TempDir folder;
};
INSTANTIATE_TEST_SUITE_P(Files, HostileBytesTest, testing::ValuesIn(examples()),
                         [](const auto& example) { return example.param.name; });

TEST_P(HostileBytesTest, CutOffAtEveryByte) {
  const Example& example = GetParam();
  const std::string whole = slurp(folder / "whole");
  const std::size_t count = example.read(folder / "whole");
  EXPECT_GT(count, 0U);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const bool was_read = try_read(whole.substr(0, size));
    // A cut inside the last number of a text cannot be seen; a .bin has no header; poses and stamps may end anywhere.
    const bool may_be_read = example.text || (example.name == "bin" && size % 16 == 0);
    EXPECT_TRUE(may_be_read || !was_read) << "cut at " << size;
    if (was_read && (example.name.starts_with("pcd") || example.name.starts_with("ply"))) {
      EXPECT_EQ(example.read(folder / "hostile"), count) << "cut at " << size;
    }
  }
}

TEST_P(HostileBytesTest, BytesTurnedOver) {
  std::mt19937 random(11);
  const std::string whole = slurp(folder / "whole");
  for (int round = 0; round < 400; ++round) {
    std::string bytes = whole;
    for (unsigned k = 0; k <= random() % 4; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    if (random() % 4 == 0) bytes.insert(random() % bytes.size(), std::to_string(random()) + std::to_string(random()));
    try_read(bytes);
  }
}

TEST_P(HostileBytesTest, RandomBytes) {
  std::mt19937 random(13);
  for (int round = 0; round < 200; ++round) {
    std::string bytes(random() % 300, '\0');
    const bool printable = round % 2 == 0;
    for (char& byte : bytes) byte = static_cast<char>(printable ? 9 + random() % 118 : random());
    try_read(bytes);
  }
}

// Random bodies behind whole headers reach what the headers guard.
TEST_P(HostileBytesTest, RandomBodies) {
  std::mt19937 random(17);
  const std::string whole = slurp(folder / "whole");
  const std::size_t data = std::max(whole.find("DATA "), whole.find("end_header") + 1);
  if (data == std::string::npos || whole.find('\n', data) == std::string::npos) return;
  const std::string header = whole.substr(0, whole.find('\n', data) + 1);
  for (int round = 0; round < 300; ++round) {
    std::string body(random() % 200, '\0');
    for (char& byte : body) byte = static_cast<char>(random() >> (round % 8));
    if (round % 3 == 0 && body.size() > 8) {  // sizes of binary_compressed that could be
      const auto packed = static_cast<char>(body.size() - 8);
      body.replace(0, 8, std::string{packed, 0, 0, 0, 110, 0, 0, 0});
    }
    try_read(header + body);
  }
}

}  // namespace
}  // namespace rilo::test
