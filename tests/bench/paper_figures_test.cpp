// The numbers that are shipped are those of the paper.
#include "bench/paper_figures.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <sstream>

#include <gtest/gtest.h>

#include "shared_folder.hpp"

namespace rilo {
namespace {

constexpr double kPrinted = 0.0055;  // two digits behind the point, of columns that are rounded too

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(PaperFigures, EveryMethodHasEverySequence) {
  ASSERT_EQ(paper_table_1().size(), 5U);
  ASSERT_EQ(paper_table_2().size(), 5U);
  ASSERT_EQ(paper_table_3().size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(paper_table_1()[i].sequences.size(), kitti_sequences().size());
    EXPECT_EQ(paper_table_2()[i].sequences.size(), kitti_sequences().size());
    EXPECT_EQ(paper_table_3()[i].sequences.size(), m2dgr_sequences().size());
    EXPECT_EQ(paper_table_1()[i].method, paper_table_2()[i].method);
    EXPECT_EQ(paper_table_1()[i].method, paper_table_3()[i].method);
  }
}

TEST(PaperFigures, AveragesOfTable1FollowFromItsColumns) {
  for (const PaperApe& method : paper_table_1()) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<double> column;
      for (const ApeTriple& ape : method.sequences) column.push_back(ape[k]);
      EXPECT_NEAR(mean_of(column), method.average[k], kPrinted) << method.method << " " << k;
    }
  }
}

TEST(PaperFigures, RmseFollowsFromMeanAndDeviation) {
  for (const PaperApe& method : paper_table_1()) {
    for (std::size_t i = 0; i < method.sequences.size(); ++i) {
      if (method.method == "Fast-gicp" && i < 2) continue;  // so printed
      const auto& [rmse, mean, deviation] = method.sequences[i];
      EXPECT_NEAR(rmse, std::hypot(mean, deviation), 0.035) << method.method << " " << kitti_sequences().at(i);
    }
  }
}

TEST(PaperFigures, AveragesOfTables2And3) {
  for (const PaperRow& row : paper_table_3()) EXPECT_NEAR(mean_of(row.sequences), row.average, kPrinted) << row.method;
  for (const PaperRow& row : paper_table_2()) {
    const bool as_printed_only = row.method == "DLO" || row.method == "KISS-ICP";
    EXPECT_NEAR(mean_of(row.sequences), row.average, as_printed_only ? 0.6 : 0.08) << row.method;
  }
}

// Numbers between the label of a table and its end, in order.
std::vector<double> numbers_of_table(const std::string& tex, const std::string& label) {
  const std::size_t begin = tex.find("\\hline", tex.find("\\label{" + label + "}"));
  const std::string table = tex.substr(begin, tex.find("\\end{tabular}", begin) - begin);
  std::string cells;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table.compare(i, 8, "\\textbf{") == 0)
      i += 7;
    else
      cells += table[i] == '&' || table[i] == '}' || table[i] == '\\' ? ' ' : table[i];
  }
  std::vector<double> numbers;
  std::istringstream words(cells);
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() + word.size()) numbers.push_back(value);
  }
  return numbers;
}

std::string paper() {
  std::ifstream stream(test::shared_folder() / "paper" / "adaptive-icp-lidar-odometry.tex", std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::vector<double> shipped_table_1() {
  std::vector<double> all;
  for (std::size_t i = 0; i <= kitti_sequences().size(); ++i) {
    if (i < kitti_sequences().size()) all.push_back(std::stod(kitti_sequences().at(i)));
    for (const PaperApe& method : paper_table_1()) {
      const ApeTriple& ape = i < kitti_sequences().size() ? method.sequences[i] : method.average;
      all.insert(all.end(), ape.begin(), ape.end());
    }
  }
  return all;
}

std::vector<double> shipped(const std::vector<PaperRow>& rows) {
  std::vector<double> all;
  for (const PaperRow& row : rows) {
    all.insert(all.end(), row.sequences.begin(), row.sequences.end());
    all.push_back(row.average);
  }
  return all;
}

TEST(PaperFigures, EqualThePapersOwnSource) {
  const std::string tex = paper();
  if (tex.empty()) GTEST_SKIP() << "the paper is not in the folder RILO_SHARED";
  auto first = numbers_of_table(tex, "tab1");
  // "\multirow{3}", "{5}" and the like of the head come before sequence 00.
  const auto wanted = shipped_table_1();
  ASSERT_GE(first.size(), wanted.size());
  first.erase(first.begin(), first.end() - static_cast<std::ptrdiff_t>(wanted.size()));
  EXPECT_EQ(first, wanted);
  auto second = numbers_of_table(tex, "tab2");
  const auto times = shipped(paper_table_2());
  ASSERT_EQ(second.size(), times.size() + kitti_sequences().size());
  second.erase(second.begin(), second.begin() + static_cast<std::ptrdiff_t>(kitti_sequences().size()));
  EXPECT_EQ(second, times);
  EXPECT_EQ(numbers_of_table(tex, "tab3"), shipped(paper_table_3()));
}

}  // namespace
}  // namespace rilo
