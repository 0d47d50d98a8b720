// Configuration files and --set, as the command takes them.
#include "cli/command_process.hpp"

namespace rilo::test {
namespace {

TEST(ConfigFlags, UnknownKeySuggestsTheNearest) {
  const TempDir folder;
  const std::string file = folder.write("wrong.yaml", "map:\n  voxel_siz: 1\n");
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"config", "--check", file},
                                                    {"config", "--dump", "--config", file},
                                                    {"run", folder.path(), "--config", file}}) {
    rilo_fails(2, arguments, {"wrong.yaml", "voxel_siz", "Did you mean map.voxel_m?"});
  }
}

TEST(ConfigFlags, WrongSettings) {
  const TempDir folder;
  for (const std::string command : {"config", "run"}) {
    const auto with = [&](const std::string& setting) {
      return std::vector<std::string>{command, command == "run" ? folder.path().string() : "--dump", "--set", setting};
    };
    rilo_fails(2, with("map.voxel_siz=1"), {"map.voxel_siz", "Did you mean map.voxel_m?"});
    rilo_fails(2, with("map.voxel_m"), {"map.voxel_m"});
    rilo_fails(2, with("map.voxel_m=wide"), {"map.voxel_m", "wide"});
    rilo_fails(2, with("map.voxel_m=-1"), {"map.voxel_m", "-1"});
    rilo_fails(2, with("map.voxel_m=nan"), {"map.voxel_m", "nan"});
    rilo_fails(2, with("=1"), {"--set"});
  }
}

TEST(ConfigFlags, FilesThatAreNoConfiguration) {
  const TempDir folder;
  rilo_fails(2, {"config", "--check", folder.write("broken.yaml", "map: [1, 2")}, {"broken.yaml"});
  rilo_fails(2, {"config", "--check", folder.write("list.yaml", "- 1\n- 2\n")}, {"list.yaml"});
  const Outcome missing = rilo_command({"config", "--check", folder / "missing.yaml"});
  EXPECT_EQ(missing.exit_code, 2) << missing.err;
  EXPECT_NE(missing.err.find("missing.yaml"), std::string::npos) << missing.err;
}

TEST(ConfigFlags, DumpIsAFixedPoint) {
  const TempDir folder;
  const std::string changed = rilo_succeeds({"config", "--dump", "--set", "map.voxel_m=0.7"}).out;
  EXPECT_NE(changed, rilo_succeeds({"config", "--dump"}).out);
  const std::string file = folder.write("changed.yaml", changed);
  EXPECT_EQ(rilo_succeeds({"config", "--dump", "--config", file}).out, changed);
  EXPECT_NE(rilo_succeeds({"config", "--check", file}).out.find("ok"), std::string::npos);
}

}  // namespace
}  // namespace rilo::test
