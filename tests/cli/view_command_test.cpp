// rilo view: what it says before it serves anything; tests/view has the rest.
#include "cli/drives.hpp"

namespace rilo::test {
namespace {

TEST(ViewCommand, SaysWhatIsNotARun) {
  const TempDir folder;
  rilo_fails(3, {"view", folder / "nowhere"}, {"nowhere", "no such folder", "rilo run --out"});
  rilo_fails(3, {"view", folder.path()}, {"neither metrics.json nor"});
  folder.write("poses_lidar.partial.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  rilo_fails(3, {"view", folder.path()}, {"metrics.json", "killed or is still running"});
  folder.write("metrics.json", "{");
  rilo_fails(3, {"view", folder.path()}, {"metrics.json", "not JSON"});
}

// Sweeps of the same numbers, of which the run has seen none; and the settings are those of another version.
TEST(ViewCommand, RefusesOtherDataThanThoseOfTheRun) {
  const TempDir folder;
  const auto out = folder / "out";
  rilo_succeeds({"run", shared_drive(), "--count", "3", "--out", out, "--no-report", "--quiet"});
  replace(out / "config.yaml", "of_another_version: 1\n");
  for (const char* name : {"0.bin", "1.bin", "2.bin"}) {
    folder.write("other/" + std::string(name), bytes_of<float>({1, 2, 3, 4, 5, 6, 7, 8}));
  }
  rilo_fails(3, {"view", out, "--data", folder / "other", "--port", "0"},
             {"other: sweep 0 has 2 points", "sweeps.csv", "--data"});
}

}  // namespace
}  // namespace rilo::test
