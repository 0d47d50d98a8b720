#include "results/metrics_json.hpp"

#include <fstream>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "console/text.hpp"
#include "io/file_bytes.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

namespace {

using Json = nlohmann::json;

template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;
template <typename T>
constexpr bool kIsGroup = std::is_class_v<T> && !kIsOptional<T> && !std::is_same_v<T, std::string> &&
                          !std::is_same_v<T, Counts> && !std::is_same_v<T, std::vector<std::string>>;

// Constant to a writer.
template <typename M, typename Metrics>
concept Is = std::is_same_v<std::remove_const_t<M>, Metrics>;

// The list of keys. `f` is a writer or a reader; key(): always written in kAll; maybe(): only when not empty.
void list(auto& f, Is<TimingMetrics> auto& m) {
  f.key("mean", m.mean);
  f.key("median", m.median);
  f.key("p95", m.p95);
  f.key("p99", m.p99);
  f.key("max", m.max);
}

void list(auto& f, Is<StageMetrics> auto& m) {
  f.key("preprocess", m.preprocess);
  f.key("initial_pose", m.initial_pose);
  f.key("registration", m.registration);
  f.key("map", m.map);
}

void list(auto& f, Is<ErrorMetrics> auto& m) {
  f.key("rmse", m.rmse);
  f.key("mean", m.mean);
  f.key("std", m.std);
  f.key("median", m.median);
  f.key("max", m.max);
}

void list(auto& f, Is<EvaluationMetrics> auto& m) {
  f.key("poses", m.poses);
  f.key("path_m", m.path_m);
  f.key("t_rel_pct", m.t_rel_pct);
  f.key("r_rel_deg_per_100m", m.r_rel_deg_per_100m);
  f.key("t_rel_protocol", m.t_rel_protocol);
  f.key("ape_m", m.ape_m);
  f.key("ape_rotation_deg", m.ape_rotation_deg);
  f.key("ape_unaligned_m", m.ape_unaligned_m);
  f.key("ape_unaligned_rotation_deg", m.ape_unaligned_rotation_deg);
  f.key("rpe_frame_m", m.rpe_frame_m);
  f.key("rpe_frame_deg", m.rpe_frame_deg);
  f.key("rpe_metre_m_per_m", m.rpe_metre_m_per_m);
  f.key("rpe_metre_deg_per_m", m.rpe_metre_deg_per_m);
  f.key("end_error_m", m.end_error_m);
  f.key("end_error_pct", m.end_error_pct);
  f.maybe("truth", m.truth);
  f.maybe("truth_instant", m.truth_instant);
}

void list(auto& f, Is<BudgetMetrics> auto& m) {
  f.key("sweep_ms", m.sweep_ms);
  f.key("points_cut", m.points_cut);
  f.key("coarse_cut", m.coarse_cut);
  f.key("over_budget", m.over_budget);
}

void list(auto& f, Is<TrialMetrics> auto& m) {
  f.key("times", m.times);
  f.key("sweeps", m.sweeps);
  f.key("better", m.better);
  f.key("on_cones", m.on_cones);
  f.key("off_cones", m.off_cones);
  f.key("lost", m.lost);
  f.key("raw", m.raw);
  f.key("compensated", m.compensated);
}

void list(auto& f, Is<StampFaults> auto& m) {
  f.key("gaps", m.gaps);
  f.key("missing_sweeps", m.missing);
  f.key("longest_gap_s", m.longest_gap_s);
  f.key("duplicates", m.duplicates);
  f.key("out_of_order", m.out_of_order);
  f.key("repeated_stamps", m.repeated);
  f.key("clock_jumps", m.clock_jumps);
  f.key("late", m.late);
  f.key("most_late_s", m.most_late_s);
}

void list_data(auto& f, auto& m) {
  f.key("rilo_version", m.rilo_version);
  f.key("command", m.command);
  f.key("data", m.data);
  f.maybe("data_path", m.data_path);
  f.key("format", m.format);
  f.key("pose_instant", m.pose_instant);
  f.key("point_times", m.point_times);
  f.key("motion_compensation", m.motion_compensation);
  f.maybe("compensation", m.compensation);
  f.key("elevation_correction_deg", m.elevation_correction_deg);
  f.key("topic", m.topic);
  f.key("frame_id", m.frame_id);
  f.key("parts", m.parts);
  f.key("bad_sweeps", m.bad_sweeps);
  f.key("stamp_faults", m.stamp_faults);
  f.key("warnings", m.warnings);
}

void list_findings(auto& f, auto& m) {
  f.key("status", m.status);
  f.key("loss_causes", m.loss_causes);
  f.key("initial_pose", m.initial_pose);
  f.key("initial_pose_reasons", m.initial_pose_reasons);
  f.key("coarse_runs", m.coarse_runs);
  f.key("mean_iterations", m.mean_iterations);
  f.maybe("flake_sweeps", m.flake_sweeps);
  f.maybe("flakes_pct", m.flakes_pct);
  f.maybe("budget", m.budget);
  f.maybe("calibration", m.calibration);
  f.key("elevation_given_deg", m.elevation_given_deg);
  f.key("elevation_initial_deg", m.elevation_initial_deg);
  f.key("elevation_offset_deg", m.elevation_offset_deg);
  f.key("elevation_offset_sigma_deg", m.elevation_offset_sigma_deg);
  f.key("elevation_offset_applied_deg", m.elevation_offset_applied_deg);
  f.key("started_over_after_sweeps", m.started_over_after_sweeps);
  f.key("beam_elevation_rms_deg", m.beam_elevation_rms_deg);
  f.key("beam_azimuth_rms_deg", m.beam_azimuth_rms_deg);
  f.maybe("evaluation", m.evaluation);
  f.maybe("truth_error", m.truth_error);
  f.maybe("selection_rate_pct", m.selection_rate_pct);
  f.maybe("coarse_rate_pct", m.coarse_rate_pct);
  f.maybe("elevation_estimated", m.elevation_estimated);
  f.maybe("repeats", m.repeats);
}

void list(auto& f, Is<RunMetrics> auto& m) {
  list_data(f, m);
  f.key("frames", m.frames);
  f.key("interrupted", m.interrupted);
  f.maybe("error", m.error);
  f.key("ms", m.ms);
  f.key("ms_note", m.ms_note);
  f.key("stage_mean_ms", m.stage_mean_ms);
  f.key("wall_s", m.wall_s);
  f.key("peak_rss_mb", m.peak_rss_mb);
  f.key("threads", m.threads);
  list_findings(f, m);
}

class Writer {
 public:
  explicit Writer(MetricKeys keys) : keys_(keys) {}

  template <typename T>
  void key(const char* name, const T& value) {
    if (value == T{} && keys_ == MetricKeys::kSparse) return;
    json[name] = value_of(value);
  }
  template <typename T>
  void maybe(const char* name, const T& value) {
    if (value != T{}) json[name] = value_of(value);
  }

  Json json = Json::object();

 private:
  template <typename T>
  Json value_of(const T& value) const {
    if constexpr (kIsOptional<T>) {
      return value ? value_of(*value) : Json(nullptr);
    } else if constexpr (kIsGroup<T>) {
      if (std::is_same_v<T, TimingMetrics> && value == T{}) return nullptr;  // no sweep
      Writer group(keys_);
      list(group, value);
      return std::move(group.json);
    } else {
      return value;
    }
  }

  MetricKeys keys_;
};

class Reader {
 public:
  Reader(const Json& json, std::filesystem::path file, std::string above = "")
      : json_(json), file_(std::move(file)), above_(std::move(above)) {}

  template <typename T>
  void key(const char* name, T& value) const {
    const auto found = json_.find(name);
    if (found != json_.end() && !found->is_null()) read(*found, above_ + name, value);
  }
  template <typename T>
  void maybe(const char* name, T& value) const {
    key(name, value);
  }

 private:
  template <typename T>
  void read(const Json& json, const std::string& name, T& value) const {
    if constexpr (kIsOptional<T>) {
      read(json, name, value.emplace());
    } else if constexpr (kIsGroup<T>) {
      need(json.is_object(), json, name, "object");
      const Reader group(json, file_, name + "/");
      list(group, value);
    } else if constexpr (std::is_same_v<T, Counts>) {
      need(json.is_object(), json, name, "object");
      for (const auto& [word, count] : json.items()) read(count, name + "/" + word, value[word]);
    } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
      need(json.is_array(), json, name, "array");
      for (const Json& text : json) read(text, name, value.emplace_back());
    } else {
      if constexpr (std::is_same_v<T, std::string>) need(json.is_string(), json, name, "string");
      if constexpr (std::is_same_v<T, bool>) need(json.is_boolean(), json, name, "boolean");
      if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) need(json.is_number(), json, name, "number");
      value = json.get<T>();
    }
  }

  void need(bool fits, const Json& json, const std::string& name, const char* expected) const {
    if (!fits) throw IoError({file_, "key " + name, json.type_name(), expected, "Run rilo run again"});
  }

  const Json& json_;
  std::filesystem::path file_;
  std::string above_;  // keys of the groups around this one
};

template <typename M>
Json json_of(const M& metrics, MetricKeys keys) {
  Writer writer(keys);
  list(writer, metrics);
  return std::move(writer.json);
}

}  // namespace

nlohmann::json to_json(const RunMetrics& metrics, MetricKeys keys) {
  Json json = json_of(metrics, keys);
  if (keys == MetricKeys::kAll && metrics.evaluated()) {
    // The headline figures at the top level too, where scripts look first.
    json["t_rel_pct"] = or_null(metrics.evaluation.t_rel_pct);
    json["r_rel_deg_per_100m"] = or_null(metrics.evaluation.r_rel_deg_per_100m);
    json["ape_rmse_m"] = or_null(metrics.evaluation.ape_m.rmse);
  }
  return json;
}

nlohmann::json to_json(const EvaluationMetrics& metrics) { return json_of(metrics, MetricKeys::kAll); }

nlohmann::json to_json(const TrialMetrics& metrics) { return json_of(metrics, MetricKeys::kAll); }

nlohmann::json to_json(const StampFaults& faults) { return json_of(faults, MetricKeys::kAll); }

nlohmann::json read_json_object(const std::filesystem::path& file, const std::string& expected,
                                const std::string& remedy) {
  std::ifstream stream(file, std::ios::binary);
  if (!detail::is_file(file) || !stream) {
    throw IoError({file, "", "no file that can be read", expected, remedy});
  }
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(stream);
  } catch (const nlohmann::json::parse_error& error) {
    throw IoError({file, fmt::format("byte {}", error.byte), "this is not JSON", expected, ""});
  } catch (const nlohmann::json::exception& error) {
    throw IoError({file, "", std::string("JSON that cannot be used: ") + error.what(), expected, remedy});
  }
  if (!json.is_object())
    throw IoError({file, "", std::string("JSON of another kind, ") + json.type_name(), expected, ""});
  return json;
}

RunMetrics metrics_of(const nlohmann::json& json, const std::filesystem::path& file) {
  RunMetrics metrics;
  const Reader reader(json, file);
  list(reader, metrics);
  return metrics;
}

}  // namespace rilo
