// rilo info: what a data set holds.
#include <algorithm>
#include <bitset>
#include <cmath>
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
#include "io/ground_truth.hpp"
#include "results/metrics_json.hpp"
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

constexpr std::size_t kSectors = 36;        // of 10°
constexpr double kPartOfRevolution = 0.75;  // of the directions of all sweeps; a whole one sees nearly all of them
using Directions = std::bitset<kSectors>;

struct Survey {
  std::size_t sweeps = 0;
  std::size_t read = 0;
  std::size_t points = 0;
  std::size_t least = 0;
  std::size_t most = 0;
  std::size_t not_finite = 0;
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
      survey.ranges.push_back(sweep.points[i].cast<double>().norm());
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
  while (const auto sweep = source.next()) {
    look_at(*sweep, survey);
    survey.stamps.push_back(sweep->stamp_ns);
    survey.sweeps += 1 + source.skip(step - 1);
  }
  return survey;
}

/// Raw or compensated, by how the first sweeps fit.
nlohmann::json compensation_json(const InfoFlags& flags) {
  if (flags.source.options.point_times == PointTimes::kNone) return nullptr;
  const OpenSource open = [&flags] { return open_scan_source(flags.data, flags.source.options); };
  const CompensationTrial trial = try_compensation(open, 0, {}, {});
  return {
      {"sweeps", trial.sweeps}, {"better", trial.better}, {"raw", trial.raw()}, {"compensated", trial.compensated()}};
}

nlohmann::json range_percentiles(std::vector<double> ranges) {
  if (ranges.empty()) return nullptr;
  std::sort(ranges.begin(), ranges.end());
  return {{"p5", percentile(ranges, 0.05)},
          {"median", percentile(ranges, 0.5)},
          {"p95", percentile(ranges, 0.95)},
          {"max", ranges.back()}};
}

/// Degrees of the horizon with points, of one sweep at most and of all that were read.
nlohmann::json directions_json(const Survey& survey) {
  constexpr std::size_t kDegrees = 360 / kSectors;
  return {{"one_sweep_deg", kDegrees * survey.sectors_max}, {"all_sweeps_deg", kDegrees * survey.directions.count()}};
}

nlohmann::json stamps_json(const Survey& survey, const SourceInfo& info, bool complete) {
  nlohmann::json json = {{"period_s", info.period_s}, {"assumed", info.stamps_assumed}};
  if (survey.stamps.empty()) return json;
  json["begin_s"] = format_stamp(survey.stamps.front());
  json["span_s"] = static_cast<double>(survey.stamps.back() - survey.stamps.front()) * 1e-9;
  if (complete) {
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

std::string word(const nlohmann::json& value) { return value.get<std::string>(); }
double real(const nlohmann::json& value) { return value.get<double>(); }
std::size_t count(const nlohmann::json& value) { return value.get<std::size_t>(); }

std::string topics_as_text(const nlohmann::json& j) {
  const auto data = word(j["data"]);
  std::string text =
      fmt::format("{}: recording with several topics of scans; --topic chooses one\n\n{:<32} {:<32} {:>8}  {}\n", data,
                  "topic", "type", "messages", "frame");
  std::string runs;
  for (const auto& topic : j["topics"]) {
    const auto name = word(topic["name"]);
    const auto frame = word(topic["frame_id"]);
    text += fmt::format("{:<32} {:<32} {:>8}  {}\n", name, word(topic["type"]),
                        topic["messages"].is_null() ? "?" : topic["messages"].dump(), frame.empty() ? "–" : frame);
    if (!topic["scans"].get<bool>()) continue;
    runs += fmt::format("{}rilo run {} --topic {} --out results\n",
                        runs.empty() ? "\nto run it     " : "              ", shell_quoted(data), shell_quoted(name));
  }
  return text + runs;
}

nlohmann::json describe(const InfoFlags& flags, ScanSource& source) {
  const Survey survey = survey_of(source, flags.all);
  const SourceInfo info = source.info();
  const bool complete = survey.read == survey.sweeps;
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
      {"stamps", stamps_json(survey, info, complete)},
      {"point_times", {{"source", info.point_times}, {"in_order", survey.in_order}}},
      {"compensation", compensation_json(flags)},
      {"intensity", survey.intensity},
      {"rings", survey.rings},
      {"calibration", info.T_cam_lidar.has_value()},
      {"elevation_correction_deg", info.elevation_correction_deg},
      {"truth", truth_json(flags.data)},
      {"topic", info.topic},
      {"frame_id", info.frame_id},
      {"stamp_faults", to_json(info.faults)},
      {"bad_sweeps", info.bad_sweeps},
      {"warnings", info.warnings},
  };
  if (survey.timed) {
    json["point_times"]["begin_s"] = survey.times_begin;
    json["point_times"]["end_s"] = survey.times_end;
  }
  return json;
}

/// What to run next. Whether points without times are raw cannot be seen from single sweeps.
std::string advice(const nlohmann::json& j) {
  const std::string run = "rilo run " + shell_quoted(word(j["data"])) + " --out results";
  const auto& compensation = j["compensation"];
  if (j["point_times"].contains("begin_s")) {
    const bool twice = !compensation.is_null() && compensation["compensated"].get<bool>();
    return "to run it     " + run + (twice ? " --point-times none\n" : "\n");
  }
  if (j["point_times"]["in_order"].get<bool>()) {
    return "to run it     " + run + "   (finds out whether the points are raw)\n" + "              " + run +
           " --point-times order   (they are)\n" + "              " + run +
           " --point-times none    (they are motion-compensated)\n";
  }
  return "to run it     " + run + " --point-times azimuth   (raw points of a spinning sensor)\n" + "              " +
         run + " --point-times none      (points that are motion-compensated)\n";
}

std::string compensation_text(const nlohmann::json& trial) {
  if (trial.is_null() || count(trial["sweeps"]) == 0) return "";
  const bool raw = trial["raw"].get<bool>();
  const bool compensated = trial["compensated"].get<bool>();
  return fmt::format(
      "motion        {} of {} sweeps fit better when their points are compensated with their times: {}\n",
      count(trial["better"]), count(trial["sweeps"]),
      raw           ? "raw points"
      : compensated ? "they are compensated already"
                    : "not certain");
}

std::string as_text(const nlohmann::json& j) {
  std::string text =
      fmt::format("{}: {}, {} sweeps of {}\n", word(j["data"]), word(j["kind"]), count(j["sweeps"]), word(j["format"]));
  if (!word(j["topic"]).empty()) {
    text += fmt::format("topic         {}, frame {}\n", word(j["topic"]), word(j["frame_id"]));
  }
  const auto& points = j["points"];
  text +=
      fmt::format("points        min {} mean {:.0f} max {}, {} not finite (of {} sweeps read)\n", count(points["min"]),
                  real(points["mean"]), count(points["max"]), count(points["not_finite"]), count(j["sweeps_read"]));
  if (!j["range_m"].is_null()) {
    const auto& range = j["range_m"];
    text += fmt::format("range         5 % {:.1f} m, median {:.1f} m, 95 % {:.1f} m, max {:.1f} m\n", real(range["p5"]),
                        real(range["median"]), real(range["p95"]), real(range["max"]));
  }
  const auto& directions = j["directions"];
  const auto one = count(directions["one_sweep_deg"]);
  const auto all = count(directions["all_sweeps_deg"]);
  text += fmt::format("directions    {}° in one sweep, {}° in all\n", one, all);
  if (static_cast<double>(one) < kPartOfRevolution * static_cast<double>(all)) {
    text +=
        "warning       a sweep seems to hold part of a revolution: let the driver send whole ones, since neighbouring "
        "parts\n              see different surroundings and begin map after map\n";
  }
  const auto& stamps = j["stamps"];
  text +=
      fmt::format("stamps        every {:.4f} s ({:.2f} Hz){}", real(stamps["period_s"]),
                  1.0 / real(stamps["period_s"]), stamps["assumed"].get<bool>() ? " (assumed: the data has none)" : "");
  if (stamps.contains("span_s")) {
    text += fmt::format(", from {} s on for {:.1f} s", word(stamps["begin_s"]), real(stamps["span_s"]));
  }
  if (stamps.contains("gaps")) {
    text += fmt::format(", {} gaps, {} not increasing", count(stamps["gaps"]), count(stamps["not_increasing"]));
  }
  text += "\npoint times   " + word(j["point_times"]["source"]);
  if (j["point_times"].contains("begin_s")) {
    text += fmt::format(", {:.4f} … {:.4f} s", real(j["point_times"]["begin_s"]), real(j["point_times"]["end_s"]));
  }
  text += '\n' + compensation_text(j["compensation"]);
  const int rings = j["rings"].get<int>();
  text += fmt::format("fields        intensity: {}; ring: {}\n", j["intensity"].get<bool>() ? "yes" : "no",
                      rings == 0 ? "no" : fmt::format("0 … {}", rings - 1));
  text += fmt::format("calibration   {}\n", j["calibration"].get<bool>() ? "LiDAR to camera (Tr)" : "none");
  const auto& truth = j["truth"];
  if (truth.is_null()) {
    text += "ground truth  none\n";
  } else if (truth.contains("error")) {
    text += "ground truth  cannot be read: " + word(truth["error"]) + "\n";
  } else {
    text += fmt::format("ground truth  {} ({} poses, {})\n", word(truth["file"]), count(truth["poses"]),
                        word(truth["instant"]));
  }
  for (const auto& warning : j["warnings"]) text += "warning       " + word(warning) + "\n";
  return text + advice(j);
}

void print_info(const InfoFlags& flags) {
  std::unique_ptr<ScanSource> source;
  try {
    source = open_scan_source(flags.data, flags.source.options);
  } catch (const IoError&) {
    const auto topics = topics_to_choose(flags);
    if (!topics) throw;
    std::cout << (flags.json ? json_text(*topics) : topics_as_text(*topics));
    return;
  }
  const nlohmann::json json = describe(flags, *source);
  std::cout << (flags.json ? json_text(json) : as_text(json));
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
  command->callback([flags, &exit_code] {
    print_info(*flags);
    exit_code = kSuccess;
  });
}

}  // namespace rilo::cli
