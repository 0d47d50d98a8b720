// The page that compares several runs.
#include <limits>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "comparison_figures.hpp"
#include "figure_table.hpp"
#include "report/report_pages.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

RunReport named(RunReport run, const std::string& name, const std::string& sequence = "") {
  run.name = name;
  run.sequence = sequence;
  return run;
}

std::string compared(const std::vector<RunReport>& runs) { return html_report(ReportPage{"", {}, runs, {}}); }

/// Data of the comparisons, after those of an overview and before those of the runs.
nlohmann::json first_comparison(const std::string& html) {
  for (const nlohmann::json& block : data_of(html)) {
    if (block.contains("runs")) return block;
  }
  return {};
}

TEST(Comparison, FiguresByHand) {
  const std::string html = compared({named(drive(301, 1.01), "long"), named(drive(301, 1.02), "longer")});
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("2 runs compared"));
  // t_rel is the scale's error; 300 m of path end 3 and 6 m too far.
  EXPECT_THAT(html, HasSubstr("<td class=\"best\"><strong>1.0000</strong></td>"));
  EXPECT_THAT(html, HasSubstr("<td>2.0000</td>"));
  EXPECT_THAT(html, HasSubstr("<td class=\"best\"><strong>3.00</strong></td>"));
  EXPECT_THAT(html, HasSubstr("<td>6.00</td>"));
  const nlohmann::json data = first_comparison(html);
  EXPECT_EQ(data["names"], nlohmann::json({"long", "longer"}));
  // 100 m: starts at 0 … 200 in steps of 10; 200 m: 0 … 100; 300 m: 0.
  EXPECT_EQ(data["lengths"][1], nlohmann::json({{100.0, 2.0, 0.0, 21}, {200.0, 2.0, 0.0, 11}, {300.0, 2.0, 0.0, 1}}));
  EXPECT_EQ(data["figures"][1]["title"], "t_rel");
  EXPECT_NEAR(data["figures"][1]["values"][1].get<double>(), 2.0, 1e-9);
}

TEST(Comparison, EveryChartHasItsFunction) {
  const std::string html =
      compared({named(drive(301), "a", "one"), named(drive(20), "b", "one"), named(drive(20), "c", "two")});
  const std::string comparisons = html.substr(html.find("<article class=\"comparison\">"));
  const std::regex chart("data-chart=\"([a-z]+)\"");
  const std::string part = comparisons.substr(0, comparisons.find("</article>"));
  std::size_t count = 0;
  for (std::sregex_iterator it(part.begin(), part.end(), chart), end; it != end; ++it, ++count) {
    EXPECT_THAT(html, HasSubstr("\n  " + (*it)[1].str() + "(comparison, host) {"));
  }
  EXPECT_EQ(count, 10U);
  // One run alone has nothing beside it.
  EXPECT_THAT(comparisons.substr(part.size()), Not(HasSubstr("data-chart=\"bars\"")));
}

TEST(Comparison, SequencesAreGroupedAndOverviewed) {
  const std::string html = compared(
      {named(drive(200), "ours", "s1"), named(drive(210), "ours", "s2"), named(drive(200, 1.03), "theirs", "s1")});
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("<h2>All sequences</h2>"));
  const std::vector<nlohmann::json> blocks = data_of(html);
  ASSERT_EQ(blocks.size(), 6U);  // overview, two sequences, three runs
  EXPECT_EQ(blocks[0]["sequences"], nlohmann::json({"s1", "s2"}));
  EXPECT_EQ(blocks[1]["runs"], nlohmann::json({0, 2}));
  EXPECT_EQ(blocks[2]["runs"], nlohmann::json({1}));
}

TEST(Comparison, HostileNamesAreText) {
  const std::string evil = "</script><img src=x onerror=alert(1)> & \"'<!--";
  const std::string html = html_report(
      ReportPage{evil, {evil}, {named(drive(30), evil, evil), named(drive(31), evil + "2", evil + "3")}, {}});
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("<img")));
  EXPECT_THAT(html, HasSubstr("&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt; &amp; &quot;&#39;&lt;!--"));
  EXPECT_EQ(first_comparison(html)["names"][0], evil);
}

TEST(Comparison, RunsWithoutTruthSweepsOrPoses) {
  RunReport bare = drive(40);
  bare.truth.clear();
  bare.evaluation.reset();
  bare.sweeps.clear();
  bare.map_points.clear();
  RunReport empty;
  RunReport broken = drive(40);
  broken.sweeps[3].stats.times.total_ms = std::numeric_limits<double>::quiet_NaN();
  const std::string html =
      compared({named(drive(40), "full"), named(bare, "bare"), named(empty, "empty"), named(broken, "broken")});
  expect_sound(html);
  const nlohmann::json data = first_comparison(html);
  EXPECT_TRUE(data["figures"][0]["values"][1].is_null());
  EXPECT_EQ(data["lengths"][1], nlohmann::json::array());
  EXPECT_THAT(html, HasSubstr("data-chart=\"patherror\""));
  const std::string without = compared({named(bare, "one"), named(bare, "two")});
  expect_sound(without);
  EXPECT_THAT(without.substr(0, without.find("<script>")), Not(HasSubstr("data-chart=\"patherror\"")));
  EXPECT_THAT(without.substr(0, without.find("<script>")), Not(HasSubstr("data-chart=\"times\"")));
}

TEST(Comparison, RecordedFiguresStandInForLostTruth) {
  RunReport run = named(drive(40), "moved");
  run.truth.clear();
  run.evaluation.reset();
  run.recorded = {{"ape_rmse_m", 0.125}, {"t_rel_pct", std::numeric_limits<double>::quiet_NaN()}};
  const auto& figures = comparison_figures();
  EXPECT_EQ(value_of(run, figures[0]), 0.125);
  EXPECT_FALSE(value_of(run, figures[1]).has_value());
  EXPECT_THAT(compared({run, named(drive(40), "here")}), HasSubstr("0.1250"));
}

TEST(Comparison, NoticesAreShown) {
  RunReport cut = named(drive(40), "cut");
  cut.notice = "The run was interrupted.";
  const std::string html = html_report(ReportPage{"", {"different sweeps"}, {cut, named(drive(40), "whole")}, {}});
  EXPECT_THAT(html, HasSubstr("<p class=\"notice\">different sweeps</p>"));
  EXPECT_THAT(html, HasSubstr("<p class=\"notice\"><b>cut:</b> The run was interrupted.</p>"));
}

TEST(FigureTable, MarksWhatIsPrintedBest) {
  const std::vector<ExperimentFigure> columns = {
      {"a", "A", "m", 2}, {"b", "B", "", 2}, {"c", "C", "", 0}, {"d", "D", "", 1}};
  const std::string html = figure_table("run", columns,
                                        {{"x", {1.001, std::nullopt, 5, 2}, ""},
                                         {"y", {1.004, std::nullopt, std::nullopt, 2.01}, ""},
                                         {"z", {1.2, std::nullopt, std::nullopt, 2}, ""}});
  // 1.001 and 1.004 print alike; a column of one value, or of equal ones, has no best; B has no value at all.
  EXPECT_THAT(html,
              HasSubstr("<th scope=\"row\">x</th><td class=\"best\"><strong>1.00</strong></td><td>5</td><td>2.0</td>"));
  EXPECT_THAT(html,
              HasSubstr("<th scope=\"row\">y</th><td class=\"best\"><strong>1.00</strong></td><td>–</td><td>2.0</td>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">z</th><td>1.20</td><td>–</td><td>2.0</td>"));
  EXPECT_THAT(html, Not(HasSubstr(">B ")));
}

}  // namespace
}  // namespace rilo::test
