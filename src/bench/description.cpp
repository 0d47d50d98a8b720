#include "bench/description.hpp"

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
          {"rate_hz", o.assumed_rate_hz},
          {"on_bad_sweep", to_string(o.on_bad_sweep)}};
}

nlohmann::json poses_json(const BenchSequence& sequence) {
  nlohmann::json json = {{"camera_frame", sequence.camera_frame}, {"max_gap_s", sequence.max_gap_s}};
  if (!sequence.ground_truth.empty()) json["truth"] = hash_of_file(sequence.ground_truth);
  for (const BenchPeer& peer : sequence.peers) json["peers"][peer.name] = hash_of_file(peer.poses);
  return json;
}

}  // namespace

void Describer::describe(BenchJob& job) {
  const RunRequest run = run_request(job.sequence, flags_);
  OdometryConfig config = job.configuration.config;
  config.threads = 0;
  job.description = {{"program", {{"version", kVersion}, {"sha256", hash_of_program()}}},
                     {"data", data_hash(job.sequence.path)},
                     {"start", run.start},
                     {"count", run.count},
                     {"reading", reading_json(run.source)},
                     {"poses", poses_json(job.sequence)},
                     {"configuration", hash_of(dump_config(config))},
                     {"repeat", job.repeat}};
  job.key = hash_of(json_text(job.description)).substr(0, kKeyDigits);
}

const std::string& Describer::data_hash(const std::filesystem::path& data) {
  std::string& hash = hashes_[data];
  if (hash.empty()) hash = hash_of_data(data, results_);
  return hash;
}

}  // namespace rilo
