#include "report/html_report.hpp"

#include <limits>
#include <regex>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/report_pages.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlReport, HasEverySection) {
  const std::string html = page(drive(301));
  expect_sound(html);
  for (const char* chart :
       {"top", "side", "error", "map", "axes", "rotation", "timing", "histogram", "status", "strips"}) {
    EXPECT_THAT(html, HasSubstr(std::string("data-chart=\"") + chart + "\"")) << chart;
  }
  for (const char* text : {"Trajectory against truth", "Accuracy", "Drift by segment length", "elevation correction",
                           "rilo run data/drive", "301 sweeps · 300.0 m of true path · 1 initialising · 300 ok"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
}

// Every chart that a page names is one that the script can draw.
TEST(HtmlReport, EveryChartHasItsFunction) {
  RunReport without_truth = drive(20);
  without_truth.evaluation.reset();
  const std::string html = page(drive(301)) + page(without_truth);
  const std::regex chart("data-chart=\"([a-z]+)\"");
  for (std::sregex_iterator it(html.begin(), html.end(), chart), end; it != end; ++it) {
    EXPECT_THAT(html, HasSubstr("\n  " + (*it)[1].str() + "(run, host) {"));
  }
}

TEST(HtmlReport, HasTheNumbers) {
  const std::string html = page(drive(301));
  EXPECT_THAT(html, HasSubstr("1.000<span class=\"unit\">%</span>"));  // t_rel
  EXPECT_THAT(html, HasSubstr("3.00<span class=\"unit\">m</span>"));   // end error
  EXPECT_THAT(html, HasSubstr("25.0<span class=\"unit\">ms</span>"));  // median of 10 … 40 ms
  EXPECT_THAT(html, HasSubstr("mean of 33 segments of 100 … 300 m"));  // 21 + 11 + 1
  EXPECT_THAT(html, HasSubstr("p99 39.7 ms, max 40.0 ms"));
  EXPECT_THAT(html, HasSubstr("4.0<span class=\"unit\">×</span>"));           // 100 ms / 25 ms
  EXPECT_THAT(html, HasSubstr("<tr><th>100</th><td>21</td><td>1.000</td>"));  // starts 0 … 200
}

TEST(HtmlReport, DataOfTheCharts) {
  const std::vector<nlohmann::json> blocks = data_of(page(drive(301)));
  ASSERT_EQ(blocks.size(), 1U);
  const nlohmann::json& data = blocks[0];
  EXPECT_EQ(data["estimate"]["x"].size(), 301U);
  EXPECT_DOUBLE_EQ(data["estimate"]["x"][100].get<double>(), 101.0);
  EXPECT_DOUBLE_EQ(data["truth"]["x"][100].get<double>(), 100.0);
  EXPECT_DOUBLE_EQ(data["errors"]["along"][300].get<double>(), 3.0);
  EXPECT_DOUBLE_EQ(data["sweeps"]["total"][10].get<double>(), 11.0);
  EXPECT_DOUBLE_EQ(data["sweeps"]["sigma"][1].get<double>(), 0.25);
  EXPECT_EQ(data["sweeps"]["status"]["names"], nlohmann::json({"initialising", "ok"}));
  EXPECT_EQ(data["sweeps"]["status"]["codes"][300], 1);
  EXPECT_EQ(data["sweeps"]["stages"][2][0], "registration");
  EXPECT_GT(data["map"]["width"].get<int>(), 10);
}

TEST(HtmlReport, SweepsKeepTheirPlacesInTheData) {
  RunReport run = drive(3);
  EXPECT_TRUE(data_of(page(run))[0]["numbers"].is_null());
  run.numbers = {100, 101, 103};
  EXPECT_EQ(data_of(page(run))[0]["numbers"], nlohmann::json({100, 101, 103}));
  run.numbers.pop_back();
  EXPECT_THROW(page(run), std::invalid_argument);
}

// A share of 0 would say that all was wrong where nothing was tried.
TEST(HtmlReport, WithoutARegistrationThereAreNoInliers) {
  RunReport run = drive(10);
  run.sweeps[0].stats.iterations = 0;
  run.sweeps[0].stats.inlier_ratio = 0;
  run.sweeps[1].stats.iterations = 3;
  const auto inliers = data_of(page(run))[0]["sweeps"]["inliers"];
  EXPECT_TRUE(inliers[0].is_null());
  EXPECT_TRUE(inliers[1].is_number());
}

TEST(HtmlReport, ManyLostSweepsAreSaidBelowTheTitle) {
  RunReport run = drive(40);
  for (std::size_t i = 0; i < 3; ++i) run.sweeps[i].status = OdometryStatus::kLost;
  EXPECT_THAT(page(run), Not(HasSubstr("sweeps are lost")));
  run.sweeps[3].status = OdometryStatus::kLost;
  EXPECT_THAT(page(run), HasSubstr("4 of 40 sweeps are lost"));
}

TEST(HtmlReport, EscapesEveryText) {
  RunReport run = drive(5);
  const std::string evil = "</script><script>alert('1')</script> & \"<u>\" <!-- \x01";
  run.title = run.dataset = run.notice = evil;
  run.facts = {{evil, evil}};
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, Not(HasSubstr("<u>")));
  EXPECT_THAT(html, Not(HasSubstr("<!--")));
  EXPECT_THAT(html,
              HasSubstr("&lt;/script&gt;&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; &quot;&lt;u&gt;&quot;"));
  EXPECT_EQ(data_of(html).size(), 1U);
}

TEST(HtmlReport, BrokenUtf8InANameDoesNotThrow) {
  RunReport run = drive(3);
  run.name = "\xff\xfe";
  expect_sound(html_report({"", {}, {run, drive(3)}, {}}));
}

TEST(HtmlReport, WithoutTruth) {
  RunReport run = drive(50);
  run.truth.clear();
  run.evaluation.reset();
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("against truth")));
  EXPECT_THAT(html.substr(0, html.find("<script>\n")), Not(HasSubstr("t_rel")));
  EXPECT_THAT(html, HasSubstr("data-chart=\"speed\""));
  EXPECT_THAT(html, HasSubstr("49.5<span class=\"unit\">m</span>"));
  EXPECT_TRUE(data_of(html)[0]["errors"].is_null());
}

TEST(HtmlReport, TheDriftOfAFewMetresIsNoHeadline) {
  EXPECT_THAT(page(drive(12, 1.2)), HasSubstr("<div class=\"label\">t_rel</div>"));
  EXPECT_THAT(page(drive(3, 1.2)), Not(HasSubstr("<div class=\"label\">t_rel</div>")));
}

TEST(HtmlReport, RecordedFiguresStandInForLostTruth) {
  RunReport run = drive(50);
  run.truth.clear();
  run.evaluation.reset();
  run.recorded = {{"ape_rmse_m", 0.125}, {"ms_median", 99.0}, {"t_rel_pct", std::numeric_limits<double>::quiet_NaN()}};
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("0.1250<span class=\"unit\">m</span></div><div class=\"note\">as the run recorded it"));
  EXPECT_THAT(html, Not(HasSubstr("99.0<span")));  // the sweeps say better
  EXPECT_THAT(html.substr(0, html.find("<script>\n")), Not(HasSubstr("t_rel")));
}

TEST(HtmlReport, OneSweepAndNone) {
  const std::string one = page(drive(1));
  expect_sound(one);
  EXPECT_THAT(one, HasSubstr("1 sweep · 0.0 m"));
  const std::string none = page(RunReport{});
  expect_sound(none);
  EXPECT_THAT(none, HasSubstr("LiDAR odometry run"));
  EXPECT_THAT(none, HasSubstr("0 sweeps"));
}

TEST(HtmlReport, ASensorAtRest) {
  RunReport run = drive(30);
  run.estimate = run.truth = std::vector<SE3>(30, SE3::Identity());
  run.evaluation = evaluate(run.truth, run.estimate);
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("The path is too short for any segment."));
  EXPECT_THAT(html, Not(HasSubstr("% of the path")));  // that has no length
}

TEST(HtmlReport, StatisticsThatAreNotFinite) {
  RunReport run = drive(10);
  run.sweeps[3].stats.times.total_ms = std::numeric_limits<double>::quiet_NaN();
  run.sweeps[4].stats.sigma_th_m = std::numeric_limits<double>::infinity();
  run.map_points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_TRUE(data_of(html)[0]["sweeps"]["total"][3].is_null());
  EXPECT_TRUE(data_of(html)[0]["sweeps"]["sigma"][4].is_null());
}

TEST(HtmlReport, WithoutTimesThereIsNoTimingChart) {
  RunReport run = drive(10);
  for (SweepResult& sweep : run.sweeps) sweep.stats.times.total_ms = 0;
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("data-chart=\"timing\"")));
  EXPECT_THAT(html, HasSubstr("data-chart=\"strips\""));
}

TEST(HtmlReport, PathsBelow150MetresSaySo) { EXPECT_THAT(page(drive(101)), HasSubstr("eighths of 80 %")); }

TEST(HtmlReport, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW(html_report({}), std::invalid_argument);
  RunReport run = drive(5);
  run.sweeps.pop_back();
  EXPECT_THROW(page(run), std::invalid_argument);
  run = drive(5);
  run.estimate[2].translation().z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(page(run), std::invalid_argument);
}

}  // namespace
}  // namespace rilo::test
