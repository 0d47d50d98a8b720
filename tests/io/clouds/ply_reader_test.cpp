#include <string>

#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::test {
namespace {

class PlyRoundTrip : public testing::TestWithParam<PlyEncoding> {};
TEST_P(PlyRoundTrip, KeepsEveryBit) {
  const TempDir folder;
  write_ply(folder / "a.ply", small_sweep(), GetParam());
  expect_same(read_ply(folder / "a.ply"), small_sweep());
  write_ply(folder / "c.ply", Sweep(), GetParam());
  EXPECT_TRUE(read_ply(folder / "c.ply").points.empty());
}
INSTANTIATE_TEST_SUITE_P(Encodings, PlyRoundTrip,
                         testing::Values(PlyEncoding::kAscii, PlyEncoding::kBinaryLittleEndian,
                                         PlyEncoding::kBinaryBigEndian));

TEST(PlyTest, ElementsAndListsAroundTheVertices) {
  const TempDir folder;
  for (const bool big : {false, true}) {
    const auto put = [big](std::string& body, auto value) {
      std::string raw = bytes_of<decltype(value)>({value});
      if (big) raw = std::string(raw.rbegin(), raw.rend());
      body += raw;
    };
    std::string body;
    put(body, 42.0);  // camera
    for (int i = 0; i < 2; ++i) {
      put(body, std::int16_t{2});
      put(body, std::int32_t{1});
      put(body, std::int32_t{2});
    }
    for (int i = 0; i < 2; ++i) {
      put(body, 1.0F + static_cast<float>(i));
      put(body, std::uint8_t{3});
      for (int k = 0; k < 3; ++k) put(body, std::uint16_t{7});
      put(body, 2.0);
      put(body, 3.0F);
      put(body, std::uint32_t{100'000'000});
    }
    const std::string header = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                               "_endian 1.0\ncomment x\nobj_info y\nelement camera 1\nproperty double f\n"
                               "element strip 2\nproperty list short int v\nelement vertex 2\nproperty float x\n"
                               "property list uchar ushort z\nproperty double y\nproperty float32 z\nproperty uint t\n"
                               "element face 9\nproperty list uchar int vertex_indices\nend_header\n";
    const RawCloud cloud = read_ply(folder.write("a.ply", header + body));
    ASSERT_EQ(cloud.points.size(), 2U);
    EXPECT_EQ(cloud.points[1], Eigen::Vector3f(2, 2, 3));
    ASSERT_TRUE(cloud.times);
    EXPECT_EQ(cloud.times->integers[1], 100'000'000);
  }
}

TEST(PlyTest, AsciiWithLists) {
  const TempDir folder;
  const auto file =
      folder.write("a.ply",
                   "ply\r\nformat ascii 1.0\r\nelement other 2\r\nproperty int a\r\nelement vertex 2\r\n"
                   "property list uchar int l\r\nproperty double x\r\nproperty float y\r\nproperty int z\r\n"
                   "property float scalar_Intensity\r\nend_header\r\n5\r\n6\r\n2 7 8 1.5 2 3 0.5\r\n"
                   "0 4 5 6 0.25\r\n");
  const RawCloud cloud = read_ply(file);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3f(1.5F, 2, 3));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.intensities, (std::vector<float>{0.5F, 0.25F}));
}

TEST(PlyTest, TextureCoordinatesAreNoTimes) {
  const TempDir folder;
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
  EXPECT_FALSE(
      read_ply(folder.write("a.ply", head + "property float s\nproperty float t\nend_header\n1 2 3 0 1\n")).times);
  EXPECT_TRUE(read_ply(folder.write("b.ply", head + "property float t\nend_header\n1 2 3 0\n")).times);
}

TEST(PlyTest, LyingHeaders) {
  const TempDir folder;
  const auto fails = [&](const std::string& text, std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("a.ply", text);
    expect_io_error([&] { read_ply(file); }, parts);
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const std::string ascii = "ply\nformat ascii 1.0\n";
  fails(binary + "element vertex 4000000000\n" + xyz + "end_header\n123456789012",
        {"4000000000 rows", "12 bytes left"});
  fails(binary + "element vertex 18446744073709551615\n" + xyz + "end_header\n", {"18446744073709551615 rows"});
  fails(binary + "element a 18446744073709551615\nproperty list uchar int l\nelement vertex 0\n" + xyz + "end_header\n",
        {"element 'a'", "18446744073709551615 rows"});
  fails(binary + "element a 1\nproperty list uint double l\nelement vertex 0\n" + xyz + "end_header\n" +
            bytes_of<std::uint32_t>({0xFFFFFFFF}),
        {"a list of 4294967295 values", "bytes left"});
  fails(binary + "element a 1\nproperty list char float l\nelement vertex 0\n" + xyz + "end_header\n\xFF",
        {"a list of -1 values"});
  fails(ascii + "element vertex 4000000000\n" + xyz + "end_header\n1 2 3\n", {"4000000000 rows"});
  fails(ascii + "element vertex 2\n" + xyz + "property list uchar int l\nend_header\n1 2 3 9999999 1\n1 2 3 0 \n",
        {"line 9", "too few values"});
  fails(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 3\n4 5 6\n", {"line 9", "another row"});
  fails(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 x\n", {"line 8, column 5", "'x'"});
  fails(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 3 4\n", {"line 8, column 7"});
  fails(ascii + "element vertex -1\n" + xyz + "end_header\n", {"line 3", "element NAME COUNT"});
  fails(ascii + "element face 0\nend_header\n", {"no element 'vertex'"});
  fails(ascii + "element vertex 0\nproperty float x\nend_header\n", {"'x'", "x, y and z"});
  fails(ascii + "element vertex 0\nproperty quad x\nend_header\n", {"'quad'"});
  fails(ascii + "element vertex 0\nproperty list float int x\nend_header\n", {"integer type"});
  fails(ascii + "property float x\nend_header\n", {"before the first element"});
  fails("ply\nformat zip 1.0\n", {"format 'zip'"});
  fails("ply\nelement vertex 0\n" + xyz + "end_header\n", {"without a format"});
  fails(ascii + "elephant\n", {"line 3", "'elephant'"});
  fails(ascii, {"without end_header"});
  fails("", {"an empty file"});
  fails("solid\n", {"'solid'"});
}

// Elements without properties take no bytes, whatever their count.
// Rows that are gathered one by one: none.
TEST(PlyTest, NoVertices) {
  const TempDir folder;
  const std::string xyz =
      "element vertex 0\nproperty float x\nproperty float y\nproperty float z\nproperty uchar ring\n";
  const std::string list = "property list uchar int l\n";
  for (const std::string& header : {"format ascii 1.0\n" + xyz, "format binary_little_endian 1.0\n" + xyz + list}) {
    const RawCloud cloud = read_ply(folder.write("n.ply", "ply\n" + header + "end_header\n"));
    EXPECT_TRUE(cloud.points.empty());
    EXPECT_TRUE(cloud.rings.empty());
  }
}

TEST(PlyTest, HugeEmptyElement) {
  const TempDir folder;
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const auto file =
        folder.write("a.ply", std::string("ply\nformat ") + format +
                                  " 1.0\nelement a 18446744073709551615\nelement vertex 0\nproperty float x\n"
                                  "property float y\nproperty float z\nend_header\n");
    EXPECT_TRUE(read_ply(file).points.empty());
  }
}

}  // namespace
}  // namespace rilo::test
