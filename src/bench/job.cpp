#include "bench/job.hpp"

#include <map>

#include <fmt/format.h>

#include "bench/content_hash.hpp"
#include "console/text.hpp"
#include "console/version.hpp"
#include "rilo/config/config_file.hpp"

namespace rilo {

namespace {

constexpr std::size_t kKeyDigits = 32;

nlohmann::json reading_json(const SourceRequest& flags) {
  const SourceOptions& o = flags.options;
  return {{"topic", o.topic},
          {"sensor_file", o.sensor_file.empty() ? "" : hash_of_file(o.sensor_file)},
          {"bin_fields", o.bin_fields},
          {"point_times", to_string(o.point_times)},
          {"times_needed", flags.times_needed},
          {"point_time_unit", to_string(o.point_time_unit)},
          {"point_time_reference", to_string(o.point_time_reference)},
          {"time_field", o.time_field},
          {"spin", to_string(o.spin_direction)},
          {"elevation_correction_deg", o.elevation_correction_deg},
          {"rate_hz", o.rate_hz.value_or(0)},  // a rate that is assumed may be changed by the run
          {"parts", o.parts},
          {"on_bad_sweep", to_string(o.on_bad_sweep)}};
}

nlohmann::json poses_json(const BenchSequence& sequence) {
  nlohmann::json json = {{"camera_frame", sequence.camera_frame}, {"max_gap_s", sequence.max_gap_s}};
  if (!sequence.ground_truth.empty()) json["truth"] = hash_of_file(sequence.ground_truth);
  for (const BenchPeer& peer : sequence.peers) json["peers"][peer.name] = hash_of_file(peer.poses);
  return json;
}

}  // namespace

std::string BenchJob::name() const {
  const std::string cell = fmt::format("{} × {}", sequence.name, configuration.name);
  return repeats == 1 ? cell : fmt::format("{}, {} of {}", cell, repeat, repeats);
}

std::vector<BenchJob> jobs_of(const BenchPlan& plan) {
  std::vector<BenchJob> jobs;
  for (const BenchSequence& sequence : plan.sequences) {
    for (const BenchConfiguration& configuration : plan.configurations) {
      BenchJob job{sequence, configuration};
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

void describe(std::vector<BenchJob>& jobs, const BenchRunOptions& flags, const std::filesystem::path& results) {
  std::map<std::filesystem::path, std::string> data;  // hashes: each folder is looked through once
  for (BenchJob& job : jobs) {
    const RunRequest run = run_request(job.sequence, flags);
    OdometryConfig config = job.configuration.config;
    config.threads = 0;
    std::string& data_hash = data[job.sequence.path];
    if (data_hash.empty()) data_hash = hash_of_data(job.sequence.path, results);
    job.description = {{"program", {{"version", kVersion}, {"sha256", hash_of_program()}}},
                       {"data", data_hash},
                       {"start", run.start},
                       {"count", run.count},
                       {"calibration", run.calibration.empty() ? "" : hash_of_file(run.calibration)},
                       {"reading", reading_json(run.source)},
                       {"poses", poses_json(job.sequence)},
                       {"configuration", hash_of(dump_config(config))},
                       {"repeat", job.repeat}};
    job.key = hash_of(json_text(job.description)).substr(0, kKeyDigits);
  }
}

}  // namespace rilo
