// Prints how time and memory of the odometry grow with its input, as CSV. scripts/scaling.sh plots it.
#include <exception>
#include <iostream>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "measured_row.hpp"
#include "scaling_studies.hpp"

namespace {

using Study = void (*)(const rilo::bench::StudySize&, std::ostream&);

const std::map<std::string, Study>& studies() {
  static const std::map<std::string, Study> kAll = {{"points", rilo::bench::study_points},
                                                    {"map", rilo::bench::study_map},
                                                    {"threads", rilo::bench::study_threads},
                                                    {"speed", rilo::bench::study_speed},
                                                    {"memory", rilo::bench::study_memory}};
  return kAll;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Time and memory of the odometry against points, map radius, threads, speed and number of sweeps (CSV)");
  std::string study = "points";
  rilo::bench::StudySize size;
  app.add_option("--study", study, "what is varied")->check(CLI::IsMember(studies()))->capture_default_str();
  auto* sweeps = app.add_option("--sweeps", size.measured, "sweeps that are measured (memory: 10000 unless given)")
                     ->check(CLI::Range(1, 1'000'000))
                     ->capture_default_str();
  app.add_option("--warm-up", size.warm_up, "sweeps before these; the study of the memory has none")
      ->check(CLI::Range(0, 10'000))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (study == "memory" && sweeps->count() == 0) {
    size.measured = 10'000;
  }
  try {
    rilo::bench::MeasuredRow::write_header(std::cout);
    studies().at(study)(size, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "scaling: " << error.what() << '\n';
    return 1;
  }
  return std::cout.good() ? 0 : 1;
}
