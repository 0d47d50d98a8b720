// Files that other programs wrote, from ../shared/data; tests are skipped where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/io_test_util.hpp"
#include "shared_folder.hpp"

namespace rilo::test {

class RealFiles : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::filesystem::path archive = shared_folder() / "data/formats.tar.xz";
    if (!std::filesystem::exists(archive)) return;
    folder = new TempDir();
    const std::string command = "tar -xJf '" + archive.string() + "' -C '" + folder->path().string() +
                                "' formats/pcd formats/ply formats/nuscenes formats/nclt formats/db3 formats/malformed "
                                "formats/pcap formats/bag1 formats/cdr";
    unpacked = std::system(command.c_str()) == 0;
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }
  void SetUp() override {
    if (folder == nullptr) GTEST_SKIP() << "no ../shared/data/formats.tar.xz";
    ASSERT_TRUE(unpacked);
  }
  static std::filesystem::path file(const std::string& name) { return folder->path() / "formats" / name; }

  inline static TempDir* folder = nullptr;
  inline static bool unpacked = false;
};

}  // namespace rilo::test
