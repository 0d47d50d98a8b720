// Experiments on the page.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiment_table.hpp"
#include "report/report_pages.hpp"

namespace rilo::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ExperimentReport experiment() {
  ExperimentReport e;
  e.title = "Ablation";
  e.figures = {{"ape", "APE rmse", "m", 3}, {"ms", "Time", "ms", 1}};
  e.cells = {{"s1", "full", false, {{"ape", 1.0}, {"ms", 20.0}}, ""},
             {"s1", "A", false, {{"ape", 3.0}}, ""},
             {"s2", "full", false, {{"ape", 2.0}}, ""},
             {"s2", "A", false, {}, "it <broke>"},
             {"s3", "full", false, {{"ape", 5.0}}, ""},
             {"s3", "A", false, {{"ape", 9.0}}, ""}};
  return e;
}

TEST(ExperimentTable, MeansAreOverCommonSequences) {
  const ExperimentTable table(experiment(), "ape");
  EXPECT_EQ(table.sequences(), (std::vector<std::string>{"s1", "s2", "s3"}));
  EXPECT_EQ(table.configurations(), (std::vector<std::string>{"full", "A"}));
  EXPECT_EQ(table.common_sequences(), 2U);  // s2 failed for A
  EXPECT_EQ(table.mean(0), 3.0);            // (1 + 5) / 2
  EXPECT_EQ(table.mean(1), 6.0);            // (3 + 9) / 2
  EXPECT_FALSE(table.at(1, 1).has_value());
}

TEST(ExperimentTable, AConfigurationThatNeverHasAFigureDoesNotHinderTheOthers) {
  const ExperimentTable table(experiment(), "ms");
  EXPECT_EQ(table.common_sequences(), 1U);
  EXPECT_EQ(table.mean(0), 20.0);
  EXPECT_FALSE(table.mean(1).has_value());
  const ExperimentTable none(experiment(), "unknown");
  EXPECT_EQ(none.common_sequences(), 0U);
  EXPECT_FALSE(none.mean(0).has_value());
}

TEST(ExperimentTable, WhatIsNotFiniteIsMissing) {
  ExperimentReport e = experiment();
  e.cells[0].figures["ape"] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(ExperimentTable(e, "ape").at(0, 0).has_value());
}

TEST(ExperimentPage, ShowsMeansFailuresAndData) {
  ExperimentReport e = experiment();
  e.notice = "The benchmark was interrupted.";
  e.facts = {{"Command", "rilo bench <x>"}};
  e.sensitivities = {{"coarse.sigma", {{0.5, "A"}, {1.0, "full"}}, "full"}};
  const std::string html = html_report(ReportPage{"", {}, {}, {e}});
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("<h2>Ablation</h2>"));
  EXPECT_THAT(html, HasSubstr("The benchmark was interrupted."));
  EXPECT_THAT(html, HasSubstr("it &lt;broke&gt;"));
  EXPECT_THAT(html, HasSubstr("<td class=\"best\"><strong>3.000</strong></td>"));
  const nlohmann::json data = data_of(html).at(0);
  EXPECT_EQ(data["figures"][0]["values"], nlohmann::json({{1.0, 3.0}, {2.0, nullptr}, {5.0, 9.0}}));
  EXPECT_EQ(data["sensitivities"][0]["points"][0], nlohmann::json({0.5, "A"}));
  for (const char* chart : {"cells", "sensitivity"}) {
    EXPECT_THAT(html, HasSubstr(std::string("data-chart=\"") + chart + "\""));
    EXPECT_THAT(html, HasSubstr(std::string("\n  ") + chart + "(experiment, host) {"));
  }
}

TEST(ExperimentPage, WithoutACommonSequenceThereAreNoMeans) {
  ExperimentReport apart;
  apart.figures = {{"ape_rmse_m", "APE rmse", "m", 3}};
  apart.cells = {{"one", "full", false, {{"ape_rmse_m", 1.0}}, ""}, {"two", "A", false, {{"ape_rmse_m", 2.0}}, ""}};
  const std::string html = html_report({"", {}, {}, {apart}});
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("no sequence has figures of every configuration"));
}

TEST(ExperimentPage, WithoutAnyFigure) {
  ExperimentReport e;
  e.title = "All failed";
  e.figures = {{"ape", "APE", "m", 3}};
  e.cells = {{"s", "c", false, {}, "no data"}};
  const std::string html = html_report(ReportPage{"", {}, {}, {e}});
  expect_sound(html);
  EXPECT_THAT(html, HasSubstr("No cell has any figure."));
  EXPECT_THAT(html.substr(0, html.find("<script>")), Not(HasSubstr("data-chart=\"cells\"")));
}

}  // namespace
}  // namespace rilo::test
