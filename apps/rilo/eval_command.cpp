// rilo eval: an estimated trajectory against ground truth.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include <fmt/format.h>

#include "command.hpp"
#include "evaluation_output.hpp"
#include "rilo/evaluation/association.hpp"
#include "rilo/io/ground_truth.hpp"
#include "rilo/io/io_error.hpp"
#include "rilo/io/pose_reader.hpp"

namespace rilo::cli {

namespace {

struct EvalFlags {
  std::string truth;
  std::string estimate;
  std::string instant = "mid";
  std::string associate = "auto";
  double max_gap_s = 0.02;
  bool json = false;
};

constexpr const char* kFooter =
    R"(GT is a pose file or a data folder with ground truth; EST is a pose file. KITTI form (12 numbers a line) or TUM form
(t x y z qx qy qz qw) is told from the first line. Both must be poses of the same sensor at the same instant of the sweep:
rilo's own are at the middle (pose_instant in metrics.json), and for a folder of a drive simulator --instant chooses the truth.

Examples:
  rilo eval drive results/poses_lidar.txt
  rilo eval gt.tum results/trajectory.tum --max-gap-s 0.05)";

/// Numbers on the first line that holds any.
std::size_t columns(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  while (std::getline(stream, line)) {
    std::istringstream words(line);
    std::string word;
    std::size_t count = 0;
    while (words >> word && word[0] != '#') {
      ++count;
    }
    if (count > 0) {
      return count;
    }
  }
  return 0;
}

struct PoseFile {
  Trajectory trajectory;
  bool stamped = false;
};

PoseFile read_poses(const std::filesystem::path& file) {
  const std::size_t count = std::filesystem::is_regular_file(file) ? columns(file) : 0;
  PoseFile poses;
  if (count == 8) {
    poses.trajectory = read_tum(file);
    poses.stamped = true;
    return poses;
  }
  if (count != 0 && count != 12) {
    throw IoError(
        {file, "first line", fmt::format("{} numbers", count), "12 (KITTI form) or 8 (TUM form)", "give a pose file"});
  }
  for (const SE3& T : read_kitti_poses(file)) {
    poses.trajectory.push_back({0, T});
  }
  return poses;
}

PoseFile read_truth(const EvalFlags& flags) {
  if (!std::filesystem::is_directory(flags.truth)) {
    return read_poses(flags.truth);
  }
  const auto truth = read_ground_truth(flags.truth, parse_truth_instant(flags.instant).value());
  if (!truth) {
    throw IoError({flags.truth, "", "no ground truth", "poses.txt, poses_mid.txt or poses_velo.txt in it",
                   "give the pose file itself"});
  }
  PoseFile poses;
  for (const SE3& T : truth->T_world_lidar) {
    poses.trajectory.push_back({0, T});
  }
  return poses;
}

MatchedPoses match(const EvalFlags& flags) {
  const PoseFile truth = read_truth(flags);
  const PoseFile estimate = read_poses(flags.estimate);
  const bool stamped = truth.stamped && estimate.stamped;
  if (flags.associate == "stamp" && !stamped) {
    throw CommandError(kUsage, "--associate stamp needs stamps in both files; a KITTI pose file has none");
  }
  try {
    if (stamped && flags.associate != "index") {
      return match_by_stamp(truth.trajectory, estimate.trajectory, static_cast<std::int64_t>(flags.max_gap_s * 1e9));
    }
    return match_by_index(truth.trajectory, estimate.trajectory);
  } catch (const std::invalid_argument& error) {
    throw CommandError(kBadData,
                       fmt::format("{} ({} poses) and {} ({} poses): {}", flags.truth, truth.trajectory.size(),
                                   flags.estimate, estimate.trajectory.size(), error.what()));
  }
}

int eval(const EvalFlags& flags) {
  const MatchedPoses matched = match(flags);
  const Evaluation result = evaluate(matched.truth, matched.estimate);
  if (flags.json) {
    nlohmann::json json = evaluation_json(result);
    json["truth"] = flags.truth;
    json["estimate"] = flags.estimate;
    std::cout << json.dump(2) << '\n';
  } else {
    std::cout << evaluation_table(result);
  }
  return kSuccess;
}

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<EvalFlags>();
  CLI::App* command = app.add_subcommand("eval", "errors of a trajectory against ground truth");
  command->footer(kFooter);
  command->add_option("GT", flags->truth, "true poses: a file, or a data folder")->required();
  command->add_option("EST", flags->estimate, "estimated poses")->required();
  command->add_option("--instant", flags->instant, "instant of the true poses when GT is a drive simulator's folder")
      ->check(CLI::IsMember({"start", "mid", "end"}))
      ->capture_default_str();
  command
      ->add_option("--associate", flags->associate,
                   "pair poses by index or by stamp; auto: by stamp when both files have stamps")
      ->check(CLI::IsMember({"auto", "index", "stamp"}))
      ->capture_default_str();
  command->add_option("--max-gap-s", flags->max_gap_s, "largest distance of two stamps that belong together")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command->add_flag("--json", flags->json, "print JSON");
  command->callback([flags, &exit_code] { exit_code = eval(*flags); });
}

}  // namespace rilo::cli
