#include "info_text.hpp"

#include <vector>

#include <fmt/format.h>

#include "console/text.hpp"
#include "results/run_metrics.hpp"

namespace rilo::cli {

namespace {

constexpr double kPartOfRevolution = 0.75;  // of the directions of all sweeps; a whole one sees nearly all of them

std::string word(const nlohmann::json& value) { return value.get<std::string>(); }
double real(const nlohmann::json& value) { return value.get<double>(); }
std::size_t count(const nlohmann::json& value) { return value.get<std::size_t>(); }
bool timed(const nlohmann::json& info) { return info["point_times"].contains("begin_s"); }
std::string listed(const nlohmann::json& names) {
  return fmt::format("{}", fmt::join(names.get<std::vector<std::string>>(), " "));
}

/// Points on the cones of the beams are raw, and yet these times do not fit them. Sweeps that were simulated at one
/// instant are raw, too, and fit no times.
bool wrong_times(const nlohmann::json& j) {
  const auto& trial = j["compensation"];
  return !trial.is_null() && trial["compensated"].get<bool>() && timed(j) &&
         2 * count(trial["on_cones"]) > count(trial["sweeps"]);
}

/// What to run next: one line where it is clear, else one for each case.
std::string advice(const nlohmann::json& j, const std::string& options) {
  const std::string run = "rilo run " + shell_quoted(word(j["data"])) + options + " --out results";
  const auto& trial = j["compensation"];
  const bool compensated = !trial.is_null() && trial["compensated"].get<bool>();
  const bool raw = !trial.is_null() && trial["raw"].get<bool>();
  if (options.find("--point-times") != std::string::npos) return "to run it     " + run + "\n";
  std::vector<std::string> lines;
  for (const auto& field : j["time_field_candidates"]) {
    lines.push_back(" --time-field " + shell_quoted(word(field)) + "   (if this field holds the points' times)");
  }
  if (timed(j)) {
    // Sparse sweeps fit no times well.
    lines.emplace_back(wrong_times(j) ? "   (if these are the points' times)"
                       : compensated  ? " --point-times none"
                                      : "");
    if (wrong_times(j)) lines.emplace_back(" --point-times none   (if they are not)");
  } else if (raw || compensated) {
    lines.emplace_back(raw ? "   (finds out that the points are raw)" : "   (finds out that they are compensated)");
  } else {
    lines.emplace_back(j["point_times"]["in_order"].get<bool>() ? " --point-times order   (raw points)"
                                                                : " --point-times azimuth   (raw points of a spinning "
                                                                  "sensor)");
    lines.emplace_back(" --point-times none   (points that are motion-compensated)");
  }
  std::string text;
  for (const std::string& line : lines)
    text += (text.empty() ? "to run it     " : "              ") + run + line + "\n";
  return text;
}

std::string points_text(const nlohmann::json& j) {
  const auto& points = j["points"];
  const std::size_t near_axis = count(points["near_axis"]);
  return fmt::format("points        min {} mean {:.0f} max {}, {} not finite{} (of {} read)\n", count(points["min"]),
                     real(points["mean"]), count(points["max"]), count(points["not_finite"]),
                     near_axis > 0 ? fmt::format(", {} within 0.1 m of the sensor's axis", near_axis) : "",
                     counted(count(j["sweeps_read"]), "sweep"));
}

std::string compensation_text(const nlohmann::json& j) {
  const auto& trial = j["compensation"];
  if (trial.is_null()) return "";
  const std::size_t lost = count(trial["lost"]);
  if (lost > count(trial["sweeps"])) {
    return fmt::format(
        "motion        {} do not fit those before them: out of order, too far apart, or too small a part of a "
        "turn?\n",
        counted(lost, "sweep"));
  }
  if (count(trial["sweeps"]) == 0) return "";
  const bool raw = trial["raw"].get<bool>();
  const bool compensated = trial["compensated"].get<bool>();
  const std::string times = word(trial["times"]);
  return fmt::format("motion        {} of {} fit better when their points are compensated with {}{}: {}\n",
                     count(trial["better"]), counted(count(trial["sweeps"]), "sweep"),
                     timed(j) ? "their times" : "the times of their " + times,
                     cones_text(count(trial["on_cones"]), count(trial["off_cones"])),
                     raw              ? "raw points"
                     : wrong_times(j) ? "raw points that these times do not fit: another field, unit or order?"
                     : compensated    ? "they are compensated already"
                                      : "not certain");
}

std::string range_text(const nlohmann::json& range) {
  if (range.is_null()) return "";
  return fmt::format("range         5 % {:.1f} m, median {:.1f} m, 95 % {:.1f} m, max {:.1f} m\n", real(range["p5"]),
                     real(range["median"]), real(range["p95"]), real(range["max"]));
}

std::string directions_text(const nlohmann::json& directions) {
  const auto one = count(directions["one_sweep_deg"]);
  const auto all = count(directions["all_sweeps_deg"]);
  std::string text = fmt::format("directions    {}° in one sweep, {}° in all\n", one, all);
  if (static_cast<double>(one) < kPartOfRevolution * static_cast<double>(all)) {
    text += fmt::format(
        "warning       a sweep seems to hold part of a revolution, and neighbouring parts see different surroundings: "
        "join them\n              (--parts {}; --rate then says how many parts a second come where the data have no "
        "stamps)\n",
        (all + one / 2) / std::max<std::size_t>(one, 1));
  }
  return text;
}

std::string stamps_text(const nlohmann::json& stamps, std::size_t sweeps) {
  const bool assumed = stamps["assumed"].get<bool>();
  std::string text = sweeps == 1 && !assumed
                         ? "stamps        of one sweep"
                         : fmt::format("stamps        every {:.4f} s ({:.2f} Hz){}", real(stamps["period_s"]),
                                       1.0 / real(stamps["period_s"]), assumed ? " (assumed: the data has none)" : "");
  if (stamps.contains("span_s")) {
    text += fmt::format(", from {} s on for {:.1f} s", word(stamps["begin_s"]), real(stamps["span_s"]));
  }
  if (stamps.contains("gaps")) {
    text +=
        fmt::format(", {}, {} not increasing", counted(count(stamps["gaps"]), "gap"), count(stamps["not_increasing"]));
  }
  return text + "\n";
}

std::string times_text(const nlohmann::json& times) {
  std::string text = "point times   " + word(times["source"]);
  if (times.contains("begin_s")) {
    text += fmt::format(", {:.4f} … {:.4f} s", real(times["begin_s"]), real(times["end_s"]));
  }
  return text + "\n";
}

std::string fields_text(const nlohmann::json& j) {
  const int rings = j["rings"].get<int>();
  std::string text = fmt::format("fields        intensity: {}; ring: {}", j["intensity"].get<bool>() ? "yes" : "no",
                                 rings == 0 ? "no" : fmt::format("0 … {}", rings - 1));
  if (!j["fields"].empty()) text += "; in the data: " + listed(j["fields"]);
  if (!j["unused_fields"].empty()) text += "; not used: " + listed(j["unused_fields"]);
  return text + "\n";
}

std::string truth_text(const nlohmann::json& truth) {
  if (truth.is_null()) return "ground truth  none\n";
  if (truth.contains("error")) return "ground truth  cannot be read: " + word(truth["error"]) + "\n";
  return fmt::format("ground truth  {} ({}, {})\n", word(truth["file"]), counted(count(truth["poses"]), "pose"),
                     word(truth["instant"]));
}

}  // namespace

std::string info_text(const nlohmann::json& j, const std::string& options) {
  std::string text = fmt::format("{}: {}, {} of {}\n", word(j["data"]), word(j["kind"]),
                                 counted(count(j["sweeps"]), "sweep"), word(j["format"]));
  if (!word(j["topic"]).empty()) {
    text += fmt::format("topic         {}, frame {}\n", word(j["topic"]), word(j["frame_id"]));
  }
  text += points_text(j) + range_text(j["range_m"]) + directions_text(j["directions"]) +
          stamps_text(j["stamps"], count(j["sweeps"])) + times_text(j["point_times"]) + compensation_text(j) +
          fields_text(j);
  text += fmt::format("camera        {}\n", j["calibration"].get<bool>() ? "LiDAR to camera (Tr)" : "none");
  text += truth_text(j["truth"]);
  for (const auto& warning : j["warnings"]) text += "warning       " + word(warning) + "\n";
  return text + advice(j, options);
}

std::string topics_text(const nlohmann::json& j) {
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

}  // namespace rilo::cli
