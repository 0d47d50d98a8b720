#include "bench/text_table.hpp"

#include <gtest/gtest.h>

namespace rilo {
namespace {

const TextTable kTable{{"name", "°"}, {{"a|<b", "1.5"}, {"ü, \"x\"\ny", "-10"}, {"short"}}, 1};

TEST(TextTable, PlainColumnsLineUpWhateverTheBytesOfACharacter) {
  EXPECT_EQ(kTable.plain(),
            "name        °\n"
            "a|<b      1.5\n"
            "ü, \"x\" y  -10\n"
            "short\n");
}

TEST(TextTable, MarkdownEscapesBarsAndKeepsARowOnALine) {
  EXPECT_EQ(kTable.markdown(),
            "| name | ° |\n"
            "|---|---:|\n"
            "| a\\|\\<b | 1.5 |\n"
            "| ü, \"x\" y | -10 |\n"
            "| short |  |\n");
}

TEST(TextTable, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(kTable.csv(),
            "name,°\n"
            "a|<b,1.5\n"
            "\"ü, \"\"x\"\"\ny\",-10\n"
            "short,\n");
}

TEST(TextTable, WithoutRows) {
  const TextTable empty{{"a", "b"}, {}, 1};
  EXPECT_EQ(empty.plain(), "a  b\n");
  EXPECT_EQ(empty.csv(), "a,b\n");
}

}  // namespace
}  // namespace rilo
