#include "rilo/report/html_report.hpp"

#include <ostream>
#include <stdexcept>
#include <string>

#include "assets.hpp"
#include "html_sections.hpp"

namespace rilo {

namespace {

void check_poses(const std::vector<SE3>& poses, const char* name) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].matrix().allFinite()) {
      throw std::invalid_argument("pose " + std::to_string(i) + " of the " + name + " is not finite");
    }
  }
}

void check(const RunReport& run) {
  if (!run.sweeps.empty() && run.sweeps.size() != run.estimate.size()) {
    throw std::invalid_argument("a report needs one line of statistics a pose: " + std::to_string(run.sweeps.size()) +
                                " lines, " + std::to_string(run.estimate.size()) + " poses");
  }
  check_poses(run.estimate, "estimate");
  check_poses(run.truth, "truth");
}

}  // namespace

void write_html_report(const RunReport& run, std::ostream& out) { write_html_report(std::vector<RunReport>{run}, out); }

void write_html_report(const std::vector<RunReport>& runs, std::ostream& out) {
  if (runs.empty()) {
    throw std::invalid_argument("a report needs at least one run");
  }
  for (const RunReport& run : runs) {
    check(run);
  }
  const std::string title = runs.size() == 1 ? title_of(runs.front()) : std::to_string(runs.size()) + " runs compared";
  // The policy forbids the page any request: what it shows is in the file.
  out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
         "script-src 'unsafe-inline'; img-src data:\">\n"
      << "<title>" << title << " · Rilo</title>\n<style>\n"
      << kReportCss << "</style>\n</head>\n<body>\n<main>\n<p class=\"brand\">Rilo · LiDAR odometry report</p>\n";
  if (runs.size() > 1) {
    out << comparison_section(runs);
  }
  for (const RunReport& run : runs) {
    out << run_section(run);
  }
  out << "<noscript><p>The charts need JavaScript; figures and tables do not.</p></noscript>\n</main>\n<script>\n"
      << kReportJs << "</script>\n</body>\n</html>\n";
}

}  // namespace rilo
