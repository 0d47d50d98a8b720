#include <cmath>
#include <stdexcept>
#include <string>

#include "io/io_test_util.hpp"
#include "io/sweep_writer.hpp"
#include "rilo/io/cloud_reader.hpp"

namespace rilo::test {
namespace {

class PcdRoundTrip : public testing::TestWithParam<PcdEncoding> {};
TEST_P(PcdRoundTrip, KeepsEveryBit) {
  const TempDir folder;
  write_pcd(folder / "a.pcd", small_sweep(), GetParam());
  expect_same(read_pcd(folder / "a.pcd"), small_sweep());
  Sweep bare;
  bare.points = small_sweep().points;
  write_pcd(folder / "b.pcd", bare, GetParam());
  const RawCloud cloud = read_pcd(folder / "b.pcd");
  EXPECT_EQ(cloud.points, bare.points);
  EXPECT_FALSE(cloud.times);
  EXPECT_TRUE(cloud.rings.empty());
  write_pcd(folder / "c.pcd", Sweep(), GetParam());
  EXPECT_TRUE(read_pcd(folder / "c.pcd").points.empty());
}
INSTANTIATE_TEST_SUITE_P(Encodings, PcdRoundTrip,
                         testing::Values(PcdEncoding::kAscii, PcdEncoding::kBinary, PcdEncoding::kBinaryCompressed));

TEST(PcdTest, AnyTypeSizeAndCount) {
  const TempDir folder;
  std::string body;
  for (int i = 0; i < 2; ++i) {
    body += bytes_of<double>({1.5 + i}) + std::string("____") + bytes_of<std::int16_t>({-7}) +
            bytes_of<float>({3, 4, 5}) + bytes_of<std::uint8_t>({200}) +
            bytes_of<std::int64_t>({1'600'000'000'000'000'000 + i * 1000}) + bytes_of<std::uint16_t>({9});
  }
  const auto file = folder.write("a.pcd",
                                 "# comment\nFIELDS x _ y normal rgb z I timestamp Ring\nSIZE 8 1 2 4 4 4 1 8 2\n"
                                 "TYPE F U I F U F U I U\nCOUNT 1 4 1 1 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nDATA binary\n" +
                                     body);
  const RawCloud cloud = read_pcd(file);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(2.5F, -7, 5));
  EXPECT_EQ(cloud.intensities[0], 200);
  EXPECT_EQ(cloud.rings[0], 9);
  ASSERT_TRUE(cloud.times);
  EXPECT_EQ(cloud.times->integers[1], 1'600'000'000'000'001'000);
}

TEST(PcdTest, AsciiWithCountsAndNan) {
  const TempDir folder;
  const auto file = folder.write(
      "a.pcd",
      "VERSION .7\r\nFIELDS h x y z t\r\nSIZE 4 4 4 4 4\r\nTYPE F F F F U\r\nCOUNT 3 1 1 1 1\r\nWIDTH 1\r\nHEIGHT 2\r\n"
      "POINTS 2\r\nDATA ascii\r\n9 9 9 nan NaN -nan 4000000000\r\n\r\n9 9 9 +1 2e0 .5 7\r\n");
  const RawCloud cloud = read_pcd(file);
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_TRUE(std::isnan(cloud.points[0].y()));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(1, 2, 0.5F));
  EXPECT_EQ(cloud.times->integers, (std::vector<std::int64_t>{4'000'000'000, 7}));
}

// As numpy.savetxt writes them.
TEST(PcdTest, AsciiWithDecimalsInWholeNumbers) {
  const TempDir folder;
  const std::string header = "FIELDS x y z ring\nSIZE 4 4 4 2\nTYPE F F F U\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n";
  EXPECT_EQ(read_pcd(folder.write("a.pcd", header + "1 2 3 5.000000\n")).rings.at(0), 5);
  EXPECT_EQ(read_pcd(folder.write("b.pcd", header + "1 2 3 5.0e+00\n")).rings.at(0), 5);
  for (const char* value : {"5.5", "nan", "1e30", "70000.0"}) {
    SCOPED_TRACE(value);
    const auto file = folder.write("c.pcd", header + "1 2 3 " + value + "\n");
    expect_io_error([&] { read_pcd(file); }, {"line 8, column 7", "uint16"});
  }
}

// As PCL once wrote them, Livox tags and lines for instance.
TEST(PcdTest, AsciiWithBytesAsThemselves) {
  const TempDir folder;
  const auto header = [](const char* size) {
    return std::string("FIELDS x y z tag line\nSIZE 4 4 4 1 ") + size +
           "\nTYPE F F F U U\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n";
  };
  const std::string rows("1 2 3 \x10 \x03\n4 5 6 \x10 \0\n", 20);
  const RawCloud cloud = read_pcd(folder.write("a.pcd", header("1") + rows));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(cloud.rings, (std::vector<std::uint16_t>{3, 0}));
  const auto wider = folder.write("b.pcd", header("2") + rows);
  expect_io_error([&] { read_pcd(wider); }, {"line 8, column 9", "uint16", "field line"});
}

TEST(PcdTest, TimeFieldAsTold) {
  const TempDir folder;
  const auto file = folder.write("a.pcd",
                                 "FIELDS x y z time gps\nSIZE 4 4 4 4 8\nTYPE F F F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n"
                                 "DATA ascii\n1 2 3 0.5 77\n");
  EXPECT_EQ(read_pcd(file).times->field, "time");
  EXPECT_EQ(read_pcd(file, "gps").times->floats[0], 77);
  expect_io_error([&] { read_pcd(file, "stamp"); }, {"'x y z time gps'", "'stamp'", "time_field"});
}

TEST(PcdTest, CompressedWithoutItsPadding) {
  const TempDir folder;
  const std::string plain = bytes_of<float>({1, 2, 10, 20, 100, 200});
  const std::string packed = lzf_compress(plain);
  const auto sizes =
      bytes_of<std::uint32_t>({static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(plain.size())});
  const std::string header =
      "FIELDS x y _ z\nSIZE 4 4 1 4\nTYPE F F U F\nCOUNT 1 1 4 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
      "binary_compressed\n";
  const RawCloud cloud = read_pcd(folder.write("a.pcd", header + sizes + packed));
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[1], Eigen::Vector3f(2, 20, 200));
}

TEST(PcdTest, LyingHeaders) {
  const TempDir folder;
  const auto fails = [&](const std::string& sizes, const std::string& body,
                         std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + sizes + body);
    expect_io_error([&] { read_pcd(file); }, parts);
  };
  const std::string huge = "WIDTH 4000000000\nHEIGHT 1\nPOINTS 4000000000\n";
  fails(huge, "DATA ascii\n1 2 3\n", {"POINTS 4000000000", "6 bytes of text"});
  fails(huge, "DATA binary\n123456789012", {"12 bytes after the header", "48000000000 bytes"});
  fails(huge, "DATA binary_compressed\n" + bytes_of<std::uint32_t>({4, 0xFFFFFFFF}) + "abcd",
        {"uncompressed size of 4294967295", "88 times"});
  fails(huge, "DATA binary_compressed\n" + bytes_of<std::uint32_t>({5, 12}) + "abcd",
        {"compressed size of 5", "at most the 4"});
  fails(huge, "DATA binary_compressed\n" + bytes_of<std::uint32_t>({4, 12}) + "abcd", {"byte "});
  fails(huge, "DATA binary_compressed\nabc", {"3 bytes after the header"});
  fails("WIDTH 4294967296\nHEIGHT 4294967296\n", "DATA binary\n", {"WIDTH 4294967296 × HEIGHT 4294967296"});
  fails("WIDTH 1\nHEIGHT 1\nPOINTS 18446744073709551615\n", "DATA binary\n", {"POINTS 18446744073709551615"});
  fails("POINTS 18446744073709551615\n", "DATA binary\n", {"18446744073709551615"});
  fails("WIDTH 0\nHEIGHT 0\nPOINTS 3\n", "DATA binary\n", {"line 8", "WIDTH 0 × HEIGHT 0 and POINTS 3"});
  fails("WIDTH -1\nHEIGHT 1\n", "DATA binary\n", {"line 5", "WIDTH '-1'"});
  fails("", "DATA binary\n", {"neither WIDTH nor POINTS"});
  fails("WIDTH 2\n", "DATA ascii\n1 2 3\n", {"POINTS 2"});
  fails("WIDTH 1\n", "DATA ascii\n1 2 3\n4 5 6\n", {"line 8", "more points"});
  fails("WIDTH 1\n", "DATA ascii\n1 2\n3 4\n", {"line 7", "2 values"});
  fails("WIDTH 1\n", "DATA ascii\n1 2 3 4\n", {"line 7, column 7"});
  fails("WIDTH 1\n", "DATA ascii\n1 two 3\n", {"line 7, column 3", "'two'", "float32"});
  fails("WIDTH 1\n", "DATA zip\n", {"DATA 'zip'"});
  fails("WIDTH 1\n", "", {"without a DATA line"});
  fails("COLOUR 1\n", "", {"line 5", "'COLOUR'"});
}

TEST(PcdTest, SenselessFields) {
  const TempDir folder;
  const auto fails = [&](const std::string& header, std::initializer_list<std::string_view> parts) {
    const auto file = folder.write("a.pcd", header + "WIDTH 0\nHEIGHT 1\nPOINTS 0\nDATA binary\n");
    expect_io_error([&] { read_pcd(file); }, parts);
  };
  fails("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n", {"3 FIELDS, 2 SIZE, 3 TYPE"});
  fails("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n", {"field 'z' with TYPE 'F' and SIZE '3'"});
  fails("FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\n", {"field 'z'"});
  fails("FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\n", {"TYPE 'Q'"});
  fails("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\n", {"COUNT '0'"});
  fails("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 99999999999\n", {"COUNT '99999999999'"});
  fails("FIELDS x y\nSIZE 4 4\nTYPE F F\n", {"'x y'", "x, y and z"});
  fails("", {"no FIELDS"});
}

TEST(SweepWriterTest, RefusesColumnsOfOtherLengths) {
  const TempDir folder;
  Sweep sweep = small_sweep();
  sweep.times_s.pop_back();
  EXPECT_THROW(write_pcd(folder / "a.pcd", sweep), std::invalid_argument);
  EXPECT_THROW(write_ply(folder / "a.ply", sweep), std::invalid_argument);
  EXPECT_THROW(write_kitti_bin(folder / "a.bin", sweep), std::invalid_argument);
  EXPECT_EQ(files_in(folder.path()), 0U);
}

}  // namespace
}  // namespace rilo::test
