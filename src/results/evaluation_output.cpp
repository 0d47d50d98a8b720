#include "results/evaluation_output.hpp"

#include <fmt/format.h>

#include "console/text.hpp"
#include "report/figures.hpp"

namespace rilo {

namespace {

std::string row(const char* name, const ErrorSummary& s, const char* unit) {
  if (s.count == 0) return fmt::format("{:<34} none: the path is too short\n", name);
  return fmt::format("{:<34} rmse {:>9.4f}  mean {:>9.4f}  std {:>9.4f}  median {:>9.4f}  max {:>9.4f} {}\n", name,
                     s.rmse, s.mean, s.std, s.median, s.max, unit);
}

}  // namespace

std::string evaluation_table(const Evaluation& e) {
  std::string text = fmt::format("{}, path {:.1f} m\n", counted(e.poses, "pose"), e.path_m);
  if (shows_t_rel(e)) {
    text += fmt::format(
        "{:<34} t_rel {:.4f} %   r_rel {:.4f} deg/100m   ({}; {})\n", "KITTI relative error",
        e.kitti.t_rel_pct().value_or(0), e.kitti.r_rel_deg_100m().value_or(0),
        counted(e.kitti.segments.size(), "segment"),
        e.kitti.short_path ? "short path: lengths k/8 of 80 % of it" : "100 … 800 m, every 10 poses, pooled");
    for (const KittiLengthError& length : e.kitti.per_length()) {
      text += fmt::format("  {:>7.1f} m {:>28} {:.4f} %         {:.4f} deg/100m\n", length.length_m, "",
                          length.t_rel_pct, length.r_rel_deg_100m);
    }
  } else {
    text += fmt::format("{:<34} none: the path is too short\n", "KITTI relative error");
  }
  text += row("APE, SE(3) Umeyama aligned", e.ape.translation_m, "m");
  text += row("APE rotation, aligned", e.ape.rotation_deg, "deg");
  text += row("APE, unaligned (first pose equal)", e.ape_unaligned.translation_m, "m");
  text += row("APE rotation, unaligned", e.ape_unaligned.rotation_deg, "deg");
  text += row("RPE per frame", e.rpe_frame.translation_m, "m");
  text += row("RPE per frame, rotation", e.rpe_frame.rotation_deg, "deg");
  text += row("RPE per metre", e.rpe_metre.translation_m, "m/m");
  text += row("RPE per metre, rotation", e.rpe_metre.rotation_deg, "deg/m");
  text += fmt::format("{:<34} {:.4f} m", "End point", e.end_error_m);
  if (e.path_m > 0) text += fmt::format(" ({:.4f} % of the path)", e.end_error_pct);
  return text + "\n";
}

nlohmann::json benchmark_json(const KittiBenchmark& b) {
  return {{"pooled",
           {{"t_rel_pct", or_null(b.pooled_t_rel_pct)}, {"r_rel_deg_per_100m", or_null(b.pooled_r_rel_deg_100m)}}},
          {"sequence_mean",
           {{"t_rel_pct", or_null(b.sequence_mean_t_rel_pct)},
            {"r_rel_deg_per_100m", or_null(b.sequence_mean_r_rel_deg_100m)}}}};
}

std::string benchmark_table(const KittiBenchmark& b, std::size_t sequences) {
  if (!b.pooled_t_rel_pct || !b.pooled_r_rel_deg_100m) return "";
  return fmt::format(
      "{}: t_rel {:.4f} %   r_rel {:.4f} deg/100m   pooled over all segments (KITTI devkit)\n"
      "{:>12} t_rel {:.4f} %   r_rel {:.4f} deg/100m   mean of the sequences' means (most papers)\n",
      counted(sequences, "sequence"), *b.pooled_t_rel_pct, *b.pooled_r_rel_deg_100m, "",
      b.sequence_mean_t_rel_pct.value_or(0), b.sequence_mean_r_rel_deg_100m.value_or(0));
}

}  // namespace rilo
