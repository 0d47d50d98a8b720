#include "results/output_check.hpp"

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include "io/file_bytes.hpp"
#include "io/folder_files.hpp"
#include "io/folders/scan_listing.hpp"
#include "results/run_outputs.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

namespace {

namespace fs = std::filesystem;

// What a run writes or removes in its folder.
constexpr std::array kNames = {"poses_lidar.txt", "poses_camera.txt", "trajectory.tum",   "trajectory.csv",
                               "trajectory.mcap", "trajectory.bag",   "config.yaml",      "sweeps.csv",
                               "metrics.json",    "report.html",      "calibration.yaml", "poses_lidar.partial.txt",
                               "map.ply",         "map.pcd"};
constexpr std::array kMaps = {"map.ply", "map.pcd"};

constexpr std::size_t kHead = 4096;  // bytes of a file that tell what it is

void check_map(const fs::path& file) { check_replaced(file, "Rilo map", "map of an earlier run", "--map"); }

[[noreturn]] void refuse(const fs::path& output, const std::string& why, const std::string& remedy) {
  throw RunError(RunErrorKind::kCannotWrite, output.string() + ": " + why + "; " + remedy);
}

// Whatever links lead there, and folders that are still to be created.
bool same(const fs::path& output, const fs::path& other) {
  std::error_code ignored;
  return fs::equivalent(fs::weakly_canonical(output, ignored), other, ignored);
}

// One that has ended leaves metrics.json, one that is still to end the poses so far.
bool has_a_run(const fs::path& folder) {
  std::ifstream stream(folder / "metrics.json", std::ios::binary);
  const std::string metrics(std::istreambuf_iterator<char>(stream), {});
  return metrics.find("\"rilo_version\"") != std::string::npos || detail::is_file(folder / "poses_lidar.partial.txt");
}

bool holds_sweeps_of(const fs::path& folder, const fs::path& data) {
  return same(folder, data) || same(folder, detail::sweep_folder(data));
}

bool holds_other_data(const fs::path& folder) {
  return !detail::files_with(folder, {".bin", ".pcd", ".ply", ".bag", ".mcap", ".db3", ".pcap", ".pcapng"}).empty() &&
         !has_a_run(folder);
}

void check_against(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    if (same(output, input)) {
      refuse(output, "is read by this run and would be replaced or removed", "choose another --out or --map");
    }
  }
}

void check_folder(const fs::path& folder, const fs::path& data, const std::vector<fs::path>& files) {
  check_apart(folder, data);
  if (has_a_run(folder)) {
    for (const char* name : kMaps) check_map(folder / name);
    return;
  }
  for (const fs::path& file : files) {
    if (detail::path_exists(file)) {
      refuse(file, "would be replaced or removed, and no earlier run has left it",
             "choose another --out, or move the file");
    }
  }
}

}  // namespace

void check_outputs(const OutputRequest& outputs, const RunRequest& run, const fs::path& config_file) {
  const std::vector<fs::path> inputs = {run.data, config_file, run.calibration, run.source.options.sensor_file};
  const fs::path map = outputs.map;
  const fs::path map_folder = map.has_parent_path() ? map.parent_path() : ".";
  if (!outputs.map.empty()) {
    check_against(map, inputs);
    if (holds_sweeps_of(map_folder, run.data)) {
      refuse(map, "lies among the data and would be read as one of them", "choose another --map");
    }
    check_map(map);
  }
  if (outputs.out.empty()) return;
  std::vector<fs::path> files;
  for (const char* name : kNames) files.push_back(fs::path(outputs.out) / name);
  if (!outputs.map.empty() && same(map_folder, outputs.out)) files.push_back(map);
  for (const fs::path& file : files) check_against(file, inputs);
  check_folder(outputs.out, run.data, files);
}

void check_apart(const fs::path& folder, const fs::path& data) {
  if (holds_sweeps_of(folder, data) || holds_other_data(folder)) {
    refuse(folder, "holds data, which could not be told from results", "choose a folder of its own as --out");
  }
}

void check_replaced(const fs::path& file, const std::string& mark, const std::string& what, const std::string& option) {
  if (!detail::is_file(file)) return;  // nothing there, or no regular file, which writing refuses
  detail::FileBytes head;
  guard_writing([&] { head = detail::read_file(file, kHead); });  // one that may not be read is not replaced either
  if (head.size > 0 && head.view().find(mark) == std::string_view::npos) {
    refuse(file, "would be replaced, and is no " + what, "choose another " + option + ", or move the file");
  }
}

}  // namespace rilo
