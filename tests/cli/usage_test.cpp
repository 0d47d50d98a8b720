// Help, version, and wrong command lines.
#include <cstdlib>
#include <regex>
#include <sys/wait.h>

#include "cli/command_process.hpp"

namespace rilo::test {
namespace {

TEST(Usage, HelpTeachesWithExamples) {
  EXPECT_NE(rilo_succeeds({"--help"}).out.find("Exit codes"), std::string::npos);
  for (const std::string command : {"run", "eval", "bench", "quality", "report", "simulate", "config", "info"}) {
    const Outcome help = rilo_succeeds({command, "--help"});
    EXPECT_NE(help.out.find("Example"), std::string::npos) << command;
    EXPECT_NE(help.out.find("rilo " + command), std::string::npos) << command;
    EXPECT_EQ(help.err, "") << command;
  }
}

TEST(Usage, Version) {
  const Outcome version = rilo_succeeds({"--version"});
  EXPECT_TRUE(std::regex_match(version.out, std::regex(R"(rilo \d+\.\d+\.\d+\n)"))) << version.out;
  EXPECT_EQ(version.err, "");
}

TEST(Usage, WhatCannotBePrintedIsNoSuccess) {
  for (const std::string word : {"--help", "--version", "man"}) {
    const int status = std::system(("\"$RILO_BIN\" " + word + " >/dev/full 2>/dev/null").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 4) << word;
  }
}

TEST(Usage, AMissingValueIsNamedAsOne) {
  rilo_fails(2, {"run", "data", "--out"}, {"--out: its value is missing. See: rilo run --help"});
}

TEST(Usage, ControlCharactersOfNamesDoNotReachTheTerminal) {
  const Outcome outcome = rilo_fails(3, {"info", "no\nsuch\x1b[31m drive"}, {"no\\nsuch\\x1b[31m drive"});
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
}

TEST(Usage, WrongCommandLinesEndWith2AndOneLine) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"drive"},
      {"run"},
      {"run", "data", "more"},
      {"run", "data", "--bogus"},
      {"run", "data", "--threads", "-2"},
      {"run", "data", "--count", "many"},
      {"run", "data", "--start", "-1"},
      {"run", "data", "--count", "-1"},
      {"run", "data", "--point-times", "guess"},
      {"run", "data", "--spin", "sideways"},
      {"eval", "one"},
      {"eval", "a", "b", "--associate", "name"},
      {"eval", "a", "b", "--max-gap-s", "-1"},
      {"quality", "one"},
      {"quality", "a", "b", "--radius", "0"},
      {"quality", "a", "b", "--max-range", "nan"},
      {"quality", "a", "b", "--window", "-1"},
      {"quality", "a", "b", "--associate", "name"},
      {"report"},
      {"report", "a", "--pose-frame", "body"},
      {"report", "a", "--max-gap-s", "-1"},
      {"bench"},
      {"bench", "plan", "--count", "-1"},
      {"bench", "plan", "--threads", "many"},
      {"bench", "kitti"},
      {"simulate"},
      {"simulate", "--out", "x", "--sensor", "vlp32"},
      {"config"},
      {"config", "--dump", "--check", "x"},
      {"info"},
      {"completion"},
      {"completion", "tcsh"},
      {"man", "page"},
  };
  for (const auto& arguments : wrong) {
    const Outcome outcome = rilo_fails(2, arguments, {"--"});
    EXPECT_EQ(outcome.out, "") << testing::PrintToString(arguments);
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << testing::PrintToString(arguments) << outcome.err;
  }
}

TEST(Usage, NamesTheWordThatIsWrongAndTheOneThatWasMeant) {
  rilo_fails(2, {"rum", "drive"}, {"unknown subcommand \"rum\"", "did you mean rilo run?", "rilo --help"});
  rilo_fails(2, {"xyzzy"}, {"unknown subcommand \"xyzzy\". See: rilo --help"});
  rilo_fails(2, {"run", "d", "--outt", "x"}, {"unknown option --outt", "did you mean --out?", "rilo run --help"});
  rilo_fails(2, {"run", "d", "--output=x"}, {"unknown option --output", "did you mean --out?"});
  rilo_fails(2, {"run", "d", "-o", "x"}, {"unknown option -o", "did you mean --out?"});
  rilo_fails(2, {"run", "d", "---"}, {"---"});
  rilo_fails(2, {"run", "d", "more"}, {"unexpected argument \"more\"", "rilo run --help"});
  rilo_fails(2, {"run", "--view", "8080", "d"}, {"unexpected argument \"d\"", "--view=8080"});
  rilo_fails(2, {"run", "d", "--view", "8080"}, {"unexpected argument \"8080\"", "--view=8080"});
  rilo_fails(2, {"bench", "show", "x", "--formatt", "csv"}, {"--formatt", "did you mean --format?", "rilo bench show"});
  rilo_fails(2, {"run", "d", "--count", "-3"}, {"\"-3\" is not a non-negative integer"});
  rilo_fails(2, {"run", "d", "--threads", "-3"}, {"\"-3\" is not an integer from 0 to 1024"});
  rilo_fails(2, {"run", "d", "--rate", "x"}, {"\"x\" is not a number from"});
}

}  // namespace
}  // namespace rilo::test
