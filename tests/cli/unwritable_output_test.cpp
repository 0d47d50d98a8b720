// Results that cannot be written: said before the run, not after hours.
#include "cli/drives.hpp"

namespace rilo::test {
namespace {

// The first sweep cannot be read either: exit code 4 rather than 3 shows which of the two came first.
std::filesystem::path drive_that_fails(const TempDir& folder) {
  auto drive = copy_of_drive(folder);
  append(sweep_file(drive, 0), 3);
  return drive;
}

TEST(UnwritableOutput, IsSaidBeforeTheRun) {
  const TempDir folder;
  const std::string drive = drive_that_fails(folder);
  const std::string file = folder.write("results", "mine");
  rilo_fails(4, {"run", drive, "--out", file}, {"results"});
  rilo_fails(4, {"run", drive, "--out", file + "/inside"}, {"results"});
  EXPECT_EQ(slurp(file), "mine");
  rilo_fails(4, {"run", drive, "--out", "/proc/rilo-results"}, {"/proc/rilo-results"});
  rilo_fails(4, {"run", drive, "--map", "/proc/map.ply"}, {"/proc/map.ply"});
  const std::string too_long(300, 'n');
  rilo_fails(4, {"run", drive, "--out", folder / too_long}, {"nnn", "File name too long"});
  rilo_fails(4, {"run", drive, "--map", folder / (too_long + ".ply")}, {"nnn", "File name too long"});
  rilo_fails(2, {"run", drive, "--map", folder / "map.xyz"}, {"map.xyz", ".ply", ".pcd"});
  rilo_fails(3, {"run", drive, "--out", folder / "good"}, {"000000.bin"});
}

TEST(UnwritableOutput, SimulateToo) {
  const TempDir folder;
  const std::string file = folder.write("results", "mine");
  rilo_fails(4, {"simulate", "--out", file, "--sensor", "vlp16", "--sweeps", "2"}, {"results"});
  rilo_fails(4, {"simulate", "--out", "/proc/drive", "--sensor", "vlp16", "--sweeps", "2"}, {"/proc/drive"});
  EXPECT_EQ(slurp(file), "mine");
  rilo_fails(4, {"simulate", "--out", folder.path(), "--sensor", "vlp16", "--sweeps", "2"}, {"results", "choose"});
  EXPECT_EQ(slurp(file), "mine");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

}  // namespace
}  // namespace rilo::test
