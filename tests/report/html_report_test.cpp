#include "rilo/report/html_report.hpp"

#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace rilo {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A drive of `n` sweeps along x, estimated 1 % too long; sweep i took 10 + i / 10 ms.
RunReport drive(std::size_t n) {
  RunReport run;
  run.title = "Drive";
  run.dataset = "data/drive";
  run.facts = {{"command", "rilo run data/drive"}, {"elevation correction", "none"}, {"pose instant", "end"}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto s = static_cast<double>(i);
    SE3 T = SE3::Identity();
    T.translation() = Eigen::Vector3d(s, 0, 0);
    run.truth.push_back(T);
    T.translation() *= 1.01;
    run.estimate.push_back(T);
    ReportSweep sweep;
    sweep.total_ms = 10.0 + s / 10.0;
    sweep.preprocess_ms = 3.0;
    sweep.registration_ms = 6.0;
    sweep.iterations = 7;
    sweep.inlier_ratio = 0.875;
    sweep.sigma_th_m = 0.25;
    sweep.status = i == 0 ? "initialising" : "ok";
    sweep.initial_pose = i == 0 ? "identity" : "prediction";
    run.sweeps.push_back(sweep);
    run.map_points.emplace_back(static_cast<float>(s), 5.0F, 1.0F);
  }
  if (n >= 2) {
    run.evaluation = evaluate(run.truth, run.estimate);
  }
  return run;
}

std::string page(const RunReport& run) {
  std::ostringstream out;
  write_html_report(run, out);
  return out.str();
}

/// The page without its pictures, whose Base64 may spell anything.
std::string without_pictures(const std::string& html) {
  std::string text;
  std::size_t from = 0;
  const std::string mark = "data:image/png;base64,";
  for (std::size_t at = html.find(mark); at != std::string::npos; at = html.find(mark, from)) {
    text += html.substr(from, at - from);
    from = html.find('"', at);
  }
  return text + html.substr(from);
}

std::vector<nlohmann::json> data_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\">";
  std::vector<nlohmann::json> blocks;
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t from = at + open.size();
    blocks.push_back(nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from)));
  }
  return blocks;
}

/// Every element opened is closed, in order. Style, script and the void elements aside.
void expect_balanced(std::string html) {
  html = std::regex_replace(without_pictures(html), std::regex("<!DOCTYPE html>"), "");
  for (const char* name : {"style", "script"}) {
    const std::string open = std::string("<") + name;
    const std::string close = std::string("</") + name + ">";
    for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open)) {
      html.erase(at, html.find(close, at) + close.size() - at);
    }
  }
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-z0-9]+)[^<>]*>");
  for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if (name == "meta") {
      continue;
    }
    if ((*it)[1].length() == 0) {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << "</" << name << "> closes nothing";
    ASSERT_EQ(open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
  EXPECT_EQ(std::regex_replace(html, tag, "").find('<'), std::string::npos) << "a stray <";
}

/// What every page must hold to, whatever it shows.
void expect_sound(const std::string& html) {
  const std::string text = without_pictures(html);
  EXPECT_EQ(text.compare(0, 15, "<!DOCTYPE html>"), 0);
  EXPECT_THAT(text, Not(HasSubstr("http://")));
  EXPECT_THAT(text, Not(HasSubstr("https://")));
  EXPECT_THAT(text, Not(HasSubstr("@import")));
  for (const char* wrong : {"nan", "NaN", "inf<", "infm", "-inf"}) {
    EXPECT_THAT(text, Not(HasSubstr(wrong)));
  }
  expect_balanced(html);
}

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
    EXPECT_THAT(html, HasSubstr("    " + (*it)[1].str() + "(run, host) {"));
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

TEST(HtmlReport, EscapesEveryText) {
  RunReport run = drive(5);
  const std::string evil = "</script><script>alert('1')</script> & \"<u>\" <!-- \x01";
  run.title = run.dataset = run.notice = evil;
  run.facts = {{evil, evil}};
  run.sweeps[2].status = evil;
  run.sweeps[3].initial_pose = evil;
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, Not(HasSubstr("<u>")));
  EXPECT_THAT(html, Not(HasSubstr("<!--")));
  EXPECT_THAT(html,
              HasSubstr("&lt;/script&gt;&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt; &amp; &quot;&lt;u&gt;&quot;"));
  ASSERT_EQ(data_of(html).size(), 1U);
  EXPECT_EQ(data_of(html)[0]["sweeps"]["status"]["names"][2], evil);
}

TEST(HtmlReport, BrokenUtf8InAStatusDoesNotThrow) {
  RunReport run = drive(3);
  run.sweeps[1].status = "\xff\xfe";
  expect_sound(page(run));
}

TEST(HtmlReport, WithoutTruth) {
  RunReport run = drive(50);
  run.truth.clear();
  run.evaluation.reset();
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("against truth")));
  EXPECT_THAT(html, Not(HasSubstr("t_rel")));
  EXPECT_THAT(html, HasSubstr("data-chart=\"speed\""));
  EXPECT_THAT(html, HasSubstr("49.5<span class=\"unit\">m</span>"));
  EXPECT_TRUE(data_of(html)[0]["errors"].is_null());
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
}

TEST(HtmlReport, StatisticsThatAreNotFinite) {
  RunReport run = drive(10);
  run.sweeps[3].total_ms = std::numeric_limits<double>::quiet_NaN();
  run.sweeps[4].sigma_th_m = std::numeric_limits<double>::infinity();
  run.map_points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_TRUE(data_of(html)[0]["sweeps"]["total"][3].is_null());
  EXPECT_TRUE(data_of(html)[0]["sweeps"]["sigma"][4].is_null());
}

TEST(HtmlReport, WithoutTimesThereIsNoTimingChart) {
  RunReport run = drive(10);
  for (ReportSweep& sweep : run.sweeps) {
    sweep.total_ms = 0;
  }
  const std::string html = page(run);
  expect_sound(html);
  EXPECT_THAT(html, Not(HasSubstr("data-chart=\"timing\"")));
  EXPECT_THAT(html, HasSubstr("data-chart=\"strips\""));
}

TEST(HtmlReport, PathsBelow150MetresSaySo) { EXPECT_THAT(page(drive(101)), HasSubstr("eighths of 80 %")); }

TEST(HtmlReport, SeveralRunsAreCompared) {
  RunReport second = drive(200);
  second.title = "Second <run>";
  second.evaluation.reset();
  std::ostringstream out;
  write_html_report({drive(301), second}, out);
  const std::string html = out.str();
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("Runs compared"));
  EXPECT_THAT(html, HasSubstr("<tr><th>Second &lt;run&gt;</th><td>–</td>"));
  EXPECT_EQ(data_of(html).size(), 2U);
}

TEST(HtmlReport, RefusesWhatDoesNotFitTogether) {
  std::ostringstream out;
  EXPECT_THROW(write_html_report(std::vector<RunReport>{}, out), std::invalid_argument);
  RunReport run = drive(5);
  run.sweeps.pop_back();
  EXPECT_THROW(write_html_report(run, out), std::invalid_argument);
  run = drive(5);
  run.estimate[2].translation().z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_html_report(run, out), std::invalid_argument);
  EXPECT_TRUE(out.str().empty());
}

}  // namespace
}  // namespace rilo
