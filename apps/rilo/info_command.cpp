// rilo info: what a data set holds.
#include <algorithm>
#include <functional>
#include <iostream>
#include <memory>
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
#include "io/stamp_difference.hpp"
#include "results/data_survey.hpp"
#include "results/metrics_json.hpp"
#include "results/run_metrics.hpp"
#include "results/unusable_sweeps.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"
#include "rilo/io/trajectory_files.hpp"
#include "session/compensation_trial.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

namespace {

constexpr const char* kInfoFooter =
    R"(Unless --point-times none is given, it also registers the first sweeps (300 at most) with and without times, to tell
raw points from compensated ones.

Example:
  rilo info kitti/sequences/00)";

struct InfoFlags {
  std::string data;
  SourceRequest source;
  bool json = false;
  bool all = false;
};

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
std::vector<std::string> warnings_of(const DataSurvey& survey, const SourceInfo& info) {
  std::vector<std::string> warnings = info.warnings;
  if (survey.read > 0 && survey.usable == 0) warnings.push_back(why_unusable(survey.points, survey.ranges, {}));
  return warnings;
}

/// Degrees of the horizon with points, of one sweep at most and of all that were read.
nlohmann::json directions_json(const DataSurvey& survey) {
  constexpr std::size_t kDegrees = 360 / kAzimuthSectors;
  return {{"one_sweep_deg", kDegrees * survey.sectors_max}, {"all_sweeps_deg", kDegrees * survey.directions.count()}};
}

nlohmann::json stamps_json(const DataSurvey& survey, const SourceInfo& info) {
  nlohmann::json json = {{"period_s", info.period_s}, {"assumed", info.stamps_assumed}};
  if (survey.stamps.empty()) return json;
  json["begin_s"] = format_stamp(survey.stamps.front());
  json["span_s"] = detail::seconds_between(survey.stamps.front(), survey.stamps.back());
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
  const DataSurvey survey = survey_of(source, flags.all);
  const SourceInfo info = source.info();
  const double mean = survey.read == 0 ? 0.0 : static_cast<double>(survey.points) / static_cast<double>(survey.read);
  nlohmann::json json = {
      {"data", flags.data},
      {"kind", info.kind},
      {"format", info.format},
      {"sweeps", survey.sweeps},
      {"sweeps_read", survey.read},
      {"points",
       {{"min", survey.least},
        {"mean", mean},
        {"max", survey.most},
        {"not_finite", survey.not_finite},
        {"near_axis", survey.near_axis}}},
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
  command->footer(kInfoFooter);
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
