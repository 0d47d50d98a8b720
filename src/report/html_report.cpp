#include "report/html_report.hpp"

#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "assets.hpp"
#include "html_sections.hpp"
#include "html_text.hpp"

namespace rilo {

namespace {

void check_poses(const std::vector<SE3>& poses, const char* name) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].matrix().allFinite()) {
      throw std::invalid_argument("pose " + std::to_string(i) + " of the " + name + " is not finite");
    }
  }
}

// None, or one a pose.
void check_count(std::size_t count, std::size_t poses, const char* one, const char* several) {
  if (count == 0 || count == poses) return;
  throw std::invalid_argument(fmt::format("a report needs one {} a pose: {} {}, {} poses", one, count, several, poses));
}

void check(const RunReport& run) {
  check_count(run.sweeps.size(), run.estimate.size(), "line of statistics", "lines");
  check_count(run.numbers.size(), run.estimate.size(), "number", "numbers");
  check_poses(run.estimate, "estimate");
  check_poses(run.truth, "truth");
}

/// Escaped.
std::string page_title(const ReportPage& page) {
  if (!page.title.empty()) return escaped(page.title);
  if (page.runs.size() > 1) return fmt::format("{} runs compared", page.runs.size());
  if (page.runs.empty()) return page.experiments.size() > 1 ? "Experiments" : "Experiment";
  return title_of(page.runs.front());
}

std::string head(const std::string& title) {
  // The policy forbids the page any request: what it shows is in the file.
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "script-src 'unsafe-inline'; img-src data:\">\n"
         "<title>" +
         title + " · Rilo</title>\n<style>\n" + kReportCss + "</style>\n</head>\n<body>\n<main>\n";
}

std::string page_header(const ReportPage& page, const std::string& title) {
  std::string html = "<header class=\"page\"><h1>" + title + "</h1>\n";
  for (const std::string& notice : page.notices) html += "<p class=\"notice\">" + escaped(notice) + "</p>\n";
  return html + "</header>\n";
}

}  // namespace

std::string html_report(const ReportPage& page) {
  if (page.runs.empty() && page.experiments.empty()) {
    throw std::invalid_argument("a report needs at least one run or experiment");
  }
  for (const RunReport& run : page.runs) check(run);
  const std::string title = page_title(page);
  const bool single = page.runs.size() == 1 && page.experiments.empty();
  std::string html = head(title) + "<p class=\"brand\">Rilo · LiDAR odometry report</p>\n";
  if (!single || !page.notices.empty() || !page.title.empty()) html += page_header(page, title);
  if (page.runs.size() > 1) {
    html += comparison_sections(page.runs);
  } else if (!page.runs.empty()) {
    html += run_section(page.runs.front());
  }
  for (const ExperimentReport& experiment : page.experiments) html += experiment_section(experiment);
  if (page.runs.size() > 1) html += folded_runs(page.runs);
  return html +
         "<noscript><p>The charts need JavaScript; figures and tables do not.</p></noscript>\n</main>\n<script>\n" +
         kReportJs + "</script>\n</body>\n</html>\n";
}

}  // namespace rilo
