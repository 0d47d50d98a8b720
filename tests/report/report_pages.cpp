#include "report/report_pages.hpp"

#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rilo::test {

using ::testing::HasSubstr;
using ::testing::Not;

namespace {

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
    if (name == "meta") continue;
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

}  // namespace

RunReport drive(std::size_t n, double scale) {
  RunReport run;
  run.title = "Drive";
  run.dataset = "data/drive";
  run.facts = {{"command", "rilo run data/drive"}, {"elevation correction", "none"}, {"pose instant", "end"}};
  for (std::size_t i = 0; i < n; ++i) {
    const auto s = static_cast<double>(i);
    SE3 T = SE3::Identity();
    T.translation() = Eigen::Vector3d(s, 0, 0);
    run.truth.push_back(T);
    T.translation() *= scale;
    run.estimate.push_back(T);
    SweepResult sweep;
    sweep.status = i == 0 ? OdometryStatus::kInitialising : OdometryStatus::kOk;
    sweep.stats.initial_pose = i == 0 ? InitialPoseSource::kIdentity : InitialPoseSource::kPrediction;
    sweep.stats.iterations = 7;
    sweep.stats.inlier_ratio = 0.875;
    sweep.stats.sigma_th_m = 0.25;
    sweep.stats.times.total_ms = 10.0 + s / 10.0;
    sweep.stats.times.preprocess_ms = 3.0;
    sweep.stats.times.registration_ms = 6.0;
    run.sweeps.push_back(sweep);
    run.map_points.emplace_back(static_cast<float>(s), 5.0F, 1.0F);
  }
  if (n >= 2) run.evaluation = evaluate(run.truth, run.estimate);
  return run;
}

std::string page(const RunReport& run) { return html_report({"", {}, {run}, {}}); }

std::vector<nlohmann::json> data_of(const std::string& html) {
  const std::string open = "<script type=\"application/json\">";
  std::vector<nlohmann::json> blocks;
  for (std::size_t at = html.find(open); at != std::string::npos; at = html.find(open, at + 1)) {
    const std::size_t from = at + open.size();
    blocks.push_back(nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from)));
  }
  return blocks;
}

void expect_sound(const std::string& html) {
  const std::string text = without_pictures(html);
  EXPECT_EQ(text.compare(0, 15, "<!DOCTYPE html>"), 0);
  EXPECT_THAT(text, Not(HasSubstr("http://")));
  EXPECT_THAT(text, Not(HasSubstr("https://")));
  EXPECT_THAT(text, Not(HasSubstr("@import")));
  for (const char* wrong : {"nan", "NaN", "inf<", "infm", "-inf"}) EXPECT_THAT(text, Not(HasSubstr(wrong)));
  expect_balanced(html);
}

}  // namespace rilo::test
