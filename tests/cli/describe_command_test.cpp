// rilo man, rilo completion.
#include <array>
#include <cstdio>
#include <regex>
#include <set>

#include <gmock/gmock.h>

#include "cli/drives.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kCommands = {"run", "eval", "bench", "quality", "report", "simulate", "config", "info"};

/// What bash offers for the last of `words`, one a line.
std::set<std::string> completed(const TempDir& folder, const std::vector<std::string>& words) {
  const std::string script = folder.write("rilo", rilo_succeeds({"completion", "bash"}).out);
  std::string line = "COMP_WORDS=(";
  for (const std::string& word : words) line += "'" + word + "' ";
  line += "); COMP_CWORD=" + std::to_string(words.size() - 1) + "; _rilo; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const std::string file = folder.write("try.sh", "source '" + script + "'\n" + line + "\n");
  FILE* pipe = popen(("bash '" + file + "' 2>&1").c_str(), "r");
  std::string out;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) out += part.data();
  EXPECT_EQ(pclose(pipe), 0) << out;
  const auto lines = lines_of(out);
  return {lines.begin(), lines.end()};
}

TEST(DescribeCommand, TheManualPageHasEverySubcommand) {
  const std::string page = rilo_succeeds({"man"}).out;
  EXPECT_EQ(page.find(".TH RILO 1"), 0U);
  for (const std::string& command : kCommands) EXPECT_THAT(page, HasSubstr("\n.SS rilo " + command + "\n")) << command;
  EXPECT_THAT(page, HasSubstr("\n.SS rilo bench kitti\n"));
  EXPECT_THAT(page, HasSubstr("\\-\\-point\\-times"));
  const std::set<std::string> requests = {".TH", ".SH", ".SS", ".TP", ".B", ".PP", ".nf", ".fi"};
  for (const std::string& line : lines_with(page, "."))
    EXPECT_TRUE(requests.count(line.substr(0, line.find(' ')))) << line;
}

TEST(DescribeCommand, BashCompletes) {
  const TempDir folder;
  const std::set<std::string> commands = completed(folder, {"rilo", ""});
  for (const std::string& command : kCommands) EXPECT_TRUE(commands.count(command)) << command;
  EXPECT_EQ(completed(folder, {"rilo", "rep"}), std::set<std::string>{"report"});
  EXPECT_EQ(completed(folder, {"rilo", "run", "data", "--point-times", ""}),
            (std::set<std::string>{"auto", "azimuth", "data", "none", "order"}));
  EXPECT_EQ(completed(folder, {"rilo", "run", "--skip-b"}), std::set<std::string>{"--skip-bad-sweeps"});
  EXPECT_EQ(completed(folder, {"rilo", "bench", "kit"}), std::set<std::string>{"kitti"});
  EXPECT_TRUE(completed(folder, {"rilo", "bench", "kitti", "--"}).count("--baseline"));
}

TEST(DescribeCommand, ZshAndFishHaveEveryOption) {
  const std::string zsh = rilo_succeeds({"completion", "zsh"}).out;
  const std::string fish = rilo_succeeds({"completion", "fish"}).out;
  EXPECT_EQ(zsh.find("#compdef rilo\n"), 0U);
  for (const std::string& command : kCommands) {
    EXPECT_THAT(zsh, HasSubstr("'rilo " + command + "')")) << command;
    EXPECT_THAT(fish, HasSubstr("-f -a " + command + " -d ")) << command;
  }
  EXPECT_THAT(zsh, HasSubstr("'--point-times["));
  EXPECT_THAT(fish, HasSubstr(" -l point-times -x -a "));
}

}  // namespace
}  // namespace rilo::test
