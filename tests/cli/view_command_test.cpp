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

}  // namespace
}  // namespace rilo::test
