// rilo info: what a data set holds.
#include <algorithm>
#include <bitset>
#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "checks.hpp"
#include "command.hpp"
#include "console/text.hpp"
#include "evaluation/percentile.hpp"
#include "info_text.hpp"
#include "io/folders/ground_truth.hpp"
#include "results/metrics_json.hpp"
#include "results/run_metrics.hpp"
#include "results/unusable_sweeps.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/point_times.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "session/compensation_trial.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

namespace {

struct InfoFlags {
  std::string data;
  SourceRequest source;
  bool json = false;
  bool all = false;
};

constexpr std::size_t kSweepsLookedAt = 50;  // sweeps whose points are read, spread evenly over the data by skipping

constexpr std::size_t kSectors = 36;  // of 10°
using Directions = std::bitset<kSectors>;

struct Survey {
  bool complete = false;  // every sweep is looked at
  std::size_t sweeps = 0;
  std::size_t read = 0;
  std::size_t points = 0;
  std::size_t least = 0;
  std::size_t most = 0;
  std::size_t not_finite = 0;
  std::size_t usable = 0;  // neither too near nor too far, as far as they are looked at
  std::vector<double> ranges;
  Directions directions;        // in which any sweep has points
  std::size_t sectors_max = 0;  // of one sweep
  std::vector<std::int64_t> stamps;
  float times_begin = 0;
  float times_end = 0;
  bool timed = false;
  bool in_order = false;  // the points of the first sweep, as a spinning sensor measured them
  int rings = 0;
  bool intensity = false;
};

std::size_t sector_of(const Eigen::Vector3f& p) {
  const double turn = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())) / (2.0 * std::numbers::pi);
  return std::min(static_cast<std::size_t>((turn + 0.5) * kSectors), kSectors - 1);
}

void look_at(const Sweep& sweep, Survey& survey) {
  const std::size_t n = sweep.points.size();
  survey.least = survey.read == 0 ? n : std::min(survey.least, n);
  survey.most = std::max(survey.most, n);
  survey.points += n;
  if (survey.read++ == 0) survey.in_order = order_times(sweep.points, 1).has_value();
  const std::size_t stride = std::max<std::size_t>(1, n / 2000);  // enough for percentiles
  Directions directions;
  for (std::size_t i = 0; i < n; ++i) {
    const bool finite = sweep.points[i].allFinite();
    survey.not_finite += finite ? 0 : 1;
    if (finite && i % stride == 0) {
      const double range_m = sweep.points[i].cast<double>().norm();
      survey.usable += within_range(range_m, PreprocessConfig{}) ? 1 : 0;
      survey.ranges.push_back(range_m);
      directions.set(sector_of(sweep.points[i]));
    }
  }
  survey.directions |= directions;
  survey.sectors_max = std::max(survey.sectors_max, directions.count());
  if (!sweep.times_s.empty()) {
    const auto [begin, end] = std::minmax_element(sweep.times_s.begin(), sweep.times_s.end());
    survey.times_begin = survey.timed ? std::min(survey.times_begin, *begin) : *begin;
    survey.times_end = survey.timed ? std::max(survey.times_end, *end) : *end;
    survey.timed = true;
  }
  for (const std::uint16_t ring : sweep.rings) survey.rings = std::max(survey.rings, static_cast<int>(ring) + 1);
  survey.intensity = survey.intensity || !sweep.intensities.empty();
}

Survey survey_of(ScanSource& source, bool all) {
  Survey survey;
  const std::size_t total = source.size().value_or(0);
  // Odd: of halves of revolutions in turn, both are looked at.
  const std::size_t step = all || total <= kSweepsLookedAt ? 1 : (total / kSweepsLookedAt) | 1;
  survey.complete = step == 1;
  while (const auto sweep = source.next()) {
    look_at(*sweep, survey);
    survey.stamps.push_back(sweep->stamp_ns);
    // The last one is looked at in any case: its stamp ends the recording.
    const std::size_t left = total - std::min(total, source.current_index() + 1);
    survey.sweeps += 1 + (left > 1 ? source.skip(std::min(step, left) - 1) : 0);
  }
  return survey;
}

/// Raw or compensated, by how the first sweeps fit.
nlohmann::json compensation_json(const InfoFlags& flags) {
  if (flags.source.options.point_times == PointTimes::kNone) return nullptr;
  const OpenSource open = [&flags] { return open_scan_source(flags.data, flags.source.options); };
  return to_json(trial_metrics(try_compensation(open, 0, {}, {})));
}

nlohmann::json range_percentiles(std::vector<double> ranges) {
  if (ranges.empty()) return nullptr;
  std::sort(ranges.begin(), ranges.end());
  return {{"p5", percentile(ranges, 0.05)},
          {"median", percentile(ranges, 0.5)},
          {"p95", percentile(ranges, 0.95)},
          {"max", ranges.back()}};
}

/// Of all fields, or of those that are not used, or that may hold times.
nlohmann::json field_names(const SourceInfo& info, const std::function<bool(const FieldInfo&)>& wanted) {
  nlohmann::json names = nlohmann::json::array();
  for (const FieldInfo& field : info.fields) {
    if (wanted(field)) names.push_back(field.name);
  }
  return names;
}

/// What is wrong, of the source and of its points.
std::vector<std::string> warnings_of(const Survey& survey, const SourceInfo& info) {
  std::vector<std::string> warnings = info.warnings;
  if (survey.read > 0 && survey.usable == 0) warnings.push_back(why_unusable(survey.points, survey.ranges, {}));
  return warnings;
}

/// Degrees of the horizon with points, of one sweep at most and of all that were read.
nlohmann::json directions_json(const Survey& survey) {
  constexpr std::size_t kDegrees = 360 / kSectors;
  return {{"one_sweep_deg", kDegrees * survey.sectors_max}, {"all_sweeps_deg", kDegrees * survey.directions.count()}};
}

nlohmann::json stamps_json(const Survey& survey, const SourceInfo& info) {
  nlohmann::json json = {{"period_s", info.period_s}, {"assumed", info.stamps_assumed}};
  if (survey.stamps.empty()) return json;
  json["begin_s"] = format_stamp(survey.stamps.front());
  json["span_s"] = static_cast<double>(survey.stamps.back() - survey.stamps.front()) * 1e-9;
  if (survey.complete) {
    const StampFaults& faults = info.faults;
    json["gaps"] = faults.gaps;
    json["not_increasing"] = faults.duplicates + faults.out_of_order + faults.repeated + faults.clock_jumps;
  }
  return json;
}

nlohmann::json truth_json(const std::string& data) {
  try {
    const auto truth = read_ground_truth(data, PoseInstant::kMid);
    return truth ? nlohmann::json{{"file", truth->file.string()},
                                  {"poses", truth->T_world_lidar.size()},
                                  {"instant", truth->instant}}
                 : nlohmann::json(nullptr);
  } catch (const IoError& error) {
    return {{"error", error.what()}};
  }
}

/// Of a recording with several topics to choose from; nothing otherwise.
std::optional<nlohmann::json> topics_to_choose(const InfoFlags& flags) {
  if (!flags.source.options.topic.empty()) return std::nullopt;
  const std::vector<TopicInfo> topics = recorded_topics(flags.data);
  if (std::count_if(topics.begin(), topics.end(), [](const TopicInfo& topic) { return topic.scans; }) < 2) {
    return std::nullopt;
  }
  nlohmann::json list = nlohmann::json::array();
  for (const TopicInfo& topic : topics) {
    list.push_back({{"name", topic.name},
                    {"type", topic.type},
                    {"messages", topic.messages ? nlohmann::json(*topic.messages) : nlohmann::json(nullptr)},
                    {"scans", topic.scans},
                    {"frame_id", topic.frame_id}});
  }
  return nlohmann::json{{"data", flags.data}, {"kind", "recording"}, {"topics", list}};
}

nlohmann::json describe(const InfoFlags& flags, ScanSource& source) {
  const Survey survey = survey_of(source, flags.all);
  const SourceInfo info = source.info();
  const double mean = survey.read == 0 ? 0.0 : static_cast<double>(survey.points) / static_cast<double>(survey.read);
  nlohmann::json json = {
      {"data", flags.data},
      {"kind", info.kind},
      {"format", info.format},
      {"sweeps", survey.sweeps},
      {"sweeps_read", survey.read},
      {"points", {{"min", survey.least}, {"mean", mean}, {"max", survey.most}, {"not_finite", survey.not_finite}}},
      {"range_m", range_percentiles(survey.ranges)},
      {"directions", directions_json(survey)},
      {"stamps", stamps_json(survey, info)},
      {"point_times", {{"source", info.point_times}, {"in_order", survey.in_order}}},
      {"compensation", compensation_json(flags)},
      {"fields", field_names(info, [](const FieldInfo&) { return true; })},
      {"unused_fields", field_names(info, [](const FieldInfo& field) { return !field.used; })},
      {"time_field_candidates", field_names(info, [](const FieldInfo& field) { return field.may_hold_times; })},
      {"intensity", survey.intensity},
      {"rings", survey.rings},
      {"calibration", info.T_cam_lidar.has_value()},
      {"elevation_correction_deg", info.elevation_correction_deg},
      {"truth", truth_json(flags.data)},
      {"topic", info.topic},
      {"frame_id", info.frame_id},
      {"stamp_faults", to_json(info.faults)},
      {"bad_sweeps", info.bad_sweeps},
      {"warnings", warnings_of(survey, info)},
  };
  if (survey.timed) {
    json["point_times"]["begin_s"] = survey.times_begin;
    json["point_times"]["end_s"] = survey.times_end;
  }
  return json;
}

/// Those that were given, of add_source_flags().
std::string source_options(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* option : command.get_options([](const CLI::Option* given) { return given->count() > 0; })) {
    const std::string name = option->get_name();
    if (name == "DATA" || name == "--json" || name == "--all") continue;
    text += " " + name;
    if (option->get_items_expected_max() > 0) text += " " + shell_quoted(option->results().back());
  }
  return text;
}

void print_info(const InfoFlags& flags, const std::string& options_text) {
  std::unique_ptr<ScanSource> source;
  SourceOptions options = flags.source.options;
  options.read_ahead = 0;  // it would read the sweeps that are skipped
  try {
    source = open_scan_source(flags.data, options);
  } catch (const IoError&) {
    const auto topics = topics_to_choose(flags);
    if (!topics) throw;
    std::cout << (flags.json ? json_text(*topics) : topics_text(*topics));
    return;
  }
  const nlohmann::json json = describe(flags, *source);
  std::cout << (flags.json ? json_text(json) : info_text(json, options_text));
}

}  // namespace

void add_info_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<InfoFlags>();
  CLI::App* command = app.add_subcommand("info", "what a data set holds");
  command->footer("Example:\n  rilo info kitti/sequences/00");
  command->add_option("DATA", flags->data, "folder or file with sweeps")->required()->check(path_given());
  command->add_flag("--all", flags->all, "read every sweep (counts gaps in the stamps too) instead of about fifty");
  command->add_flag("--json", flags->json, "print JSON");
  add_source_flags(*command, flags->source);
  command->callback([flags, command, &exit_code] {
    print_info(*flags, source_options(*command));
    exit_code = kSuccess;
  });
}

}  // namespace rilo::cli
