#include "bench/job.hpp"

#include <fmt/format.h>

namespace rilo {

std::string BenchJob::name() const {
  const std::string cell = fmt::format("{} × {}", sequence.name, configuration.name);
  return repeats == 1 ? cell : fmt::format("{}, {} of {}", cell, repeat, repeats);
}

std::vector<BenchJob> jobs_of(const BenchPlan& plan) {
  std::vector<BenchJob> jobs;
  for (const BenchSequence& sequence : plan.sequences) {
    for (const BenchConfiguration& configuration : plan.configurations) {
      BenchJob job;
      job.sequence = sequence;
      job.configuration = configuration;
      if (configuration.elevation_correction_deg) {
        job.sequence.elevation_correction_deg = configuration.elevation_correction_deg;
      }
      jobs.push_back(job);
    }
  }
  return repeated(jobs, plan.repeats);
}

std::vector<BenchJob> repeated(const std::vector<BenchJob>& jobs, std::size_t repeats) {
  std::vector<BenchJob> result;
  for (const BenchJob& job : jobs) {
    for (std::size_t i = 1; i <= repeats; ++i) {
      result.push_back(job);
      result.back().repeat = i;
      result.back().repeats = repeats;
    }
  }
  return result;
}

}  // namespace rilo
