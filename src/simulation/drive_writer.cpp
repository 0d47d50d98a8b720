#include "simulation/drive_writer.hpp"

#include <cerrno>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "io/atomic_file.hpp"
#include "rilo/io/trajectory_files.hpp"

namespace rilo {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what, int error) {
  const std::string reason = error != 0 ? std::generic_category().message(error) : "unknown reason";
  throw std::runtime_error(path.string() + ": " + what + ": " + reason);
}

void write_floats(const fs::path& path, const std::vector<float>& values) {
  write_atomically(path, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

void create_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error)) fail(path, "cannot be created", error ? error.value() : ENOTDIR);
}

// Of the command, where the folder itself cannot be locked: whoever holds it goes on holding it.
constexpr std::string_view kLock = ".rilo.lock";

// There from before anything of an earlier drive goes until meta.json is in place: what a killed simulation left is
// recognised by it.
constexpr const char* kUnfinished = "meta.partial.json";
constexpr const char* kMeta = "meta.json";
constexpr std::string_view kGenerator = "\"generator\": \"rilo simulate\"";

bool says_it_is_ours(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  return text.find(kGenerator) != std::string::npos;
}

// All but the lock. @throws unless these are nothing but the files of an earlier drive: a KITTI sequence has the same
// names.
std::vector<fs::path> files_of_earlier_drive(const fs::path& folder) {
  static const std::set<std::string> kOurs = {"velodyne",  "times_pt",      "times.txt",     "calib.txt",
                                              "poses.txt", "poses_mid.txt", "poses_end.txt", "poses_start.txt",
                                              kMeta,       kUnfinished};
  std::error_code error;
  std::vector<fs::path> found;
  bool holds_a_drive = false;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& path = it->path();
    if (path.filename() == kLock) continue;
    const std::string name = path.filename().string();
    const std::optional<std::string> unfinished = name_of_unfinished(name);
    if (kOurs.count(unfinished.value_or(name)) == 0) {
      throw std::runtime_error(path.string() + ": is not part of a simulated drive; choose an empty folder");
    }
    found.push_back(path);
    holds_a_drive = holds_a_drive || !unfinished;
  }
  if (error) fail(folder, "cannot be listed", error.value());
  if (holds_a_drive && !says_it_is_ours(folder / kMeta) && !says_it_is_ours(folder / kUnfinished)) {
    throw std::runtime_error(
        folder.string() + ": holds data, and no meta.json says that rilo simulate made them; choose an empty folder");
  }
  return found;
}

void take_away(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (error) fail(path, "cannot be removed", error.value());
}

// Only what an earlier drive left is taken away, never something else that the folder holds.
void prepare_folder(const fs::path& folder) {
  create_folder(folder);
  const std::vector<fs::path> earlier = files_of_earlier_drive(folder);
  write_atomically(folder / kUnfinished, "{" + std::string(kGenerator) + "}\n");
  take_away(folder / kMeta);  // first: from here on the old drive is recognisably incomplete
  for (const fs::path& path : earlier) {
    if (path.filename() != kUnfinished) take_away(path);
  }
}

std::string file_name(std::size_t i) {
  const std::string number = std::to_string(i);
  return std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number + ".bin";
}

void write_sweep(const fs::path& folder, std::size_t i, const Sweep& sweep, double period_s) {
  std::vector<float> values;
  values.reserve(4 * sweep.points.size());
  for (std::size_t k = 0; k < sweep.points.size(); ++k) {
    const Eigen::Vector3f& p = sweep.points[k];
    values.insert(values.end(), {p.x(), p.y(), p.z(), sweep.intensities[k]});
  }
  write_floats(folder / "velodyne" / file_name(i), values);
  if (sweep.times_s.empty()) return;
  values.clear();
  for (const float t : sweep.times_s) values.push_back(static_cast<float>(static_cast<double>(t) / period_s));
  write_floats(folder / "times_pt" / file_name(i), values);
}

struct PoseTexts {
  std::string start, mid, end;
  std::ostringstream times;

  PoseTexts() { times << std::scientific << std::setprecision(9); }
  void append(const SimulatedSweep& s) {
    start += kitti_line(s.T_odom_lidar_start);
    mid += kitti_line(s.T_odom_lidar_mid);
    end += kitti_line(s.T_odom_lidar_end);
    times << static_cast<double>(s.sweep.stamp_ns) * 1e-9 << '\n';
  }
};

std::string calibration() {
  const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  std::string text;
  for (const char* name : {"P0", "P1", "P2", "P3", "Tr"}) text += std::string(name) + ": " + identity;
  return text;
}

std::string description(const DriveSimulator& drive, const DriveSummary& summary) {
  const DriveConfig& c = drive.config();
  const bool deskewed = c.deskewed;
  std::ostringstream text;
  text << std::setprecision(10) << std::boolalpha;
  text << "{\n"
       << "  " << kGenerator << ",\n"
       << "  \"seed\": " << c.seed << ",\n"
       << "  \"scene\": \"town\",\n"
       << "  \"sensor\": \"" << to_string(c.sensor) << "\",\n"
       << "  \"frames\": " << summary.sweeps << ",\n"
       << "  \"points\": " << summary.points << ",\n"
       << "  \"path_m\": " << summary.path_m << ",\n"
       << "  \"rate_hz\": " << 1 / drive.sensor().period_s << ",\n"
       << "  \"deskewed\": " << deskewed << ",\n"
       << "  \"reference_time\": \"" << (deskewed ? "mid" : "end") << " of the sweep\",\n"
       << "  \"stamps\": \"start of the sweep\",\n"
       << "  \"points_refer_to\": \""
       << (deskewed ? "the mid-sweep pose"
                    : "the sensor's pose at each point's own time (times_pt: fraction of the sweep)")
       << "\",\n"
       << "  \"order\": \"firing order, clockwise from straight behind, topmost beam first\",\n"
       << "  \"start_s\": " << c.start_s << ",\n"
       << "  \"speed_m_s\": " << c.speed_mps << ",\n"
       << "  \"range_noise_sigma_m\": " << c.noise_m << ",\n"
       << "  \"dropout\": " << c.dropout << ",\n"
       << "  \"range_max_m\": " << (c.max_range_m > 0 ? c.max_range_m : drive.sensor().max_range_m) << ",\n"
       << "  \"intrinsic_elevation_bias_deg\": " << c.elevation_bias_deg << ",\n"
       << "  \"moving_cars\": " << c.moving_cars << ",\n"
       << "  \"parked_cars\": " << c.parked_cars << ",\n"
       << "  \"trees\": " << c.trees << "\n"
       << "}\n";
  return text.str();
}

void write_texts(const DriveSimulator& drive, const fs::path& folder, const PoseTexts& poses) {
  write_atomically(folder / "times.txt", poses.times.str());
  write_atomically(folder / "calib.txt", calibration());
  write_atomically(folder / "poses_start.txt", poses.start);
  write_atomically(folder / "poses_mid.txt", poses.mid);
  write_atomically(folder / "poses_end.txt", poses.end);
  write_atomically(folder / "poses.txt", drive.config().deskewed ? poses.mid : poses.end);
}

}  // namespace

DriveSummary write_drive(const DriveSimulator& drive, const fs::path& folder, const DriveProgress& progress) {
  prepare_folder(folder);
  create_folder(folder / "velodyne");
  if (!drive.config().deskewed) create_folder(folder / "times_pt");
  DriveSummary summary;
  PoseTexts poses;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (bool go_on = true; go_on && summary.sweeps < drive.size();) {
    const SimulatedSweep s = drive.sweep(summary.sweeps);
    write_sweep(folder, summary.sweeps, s.sweep, drive.sensor().period_s);
    poses.append(s);
    summary.points += s.sweep.points.size();
    summary.path_m += (s.T_odom_lidar_mid.translation() - last).norm();
    last = s.T_odom_lidar_mid.translation();
    ++summary.sweeps;
    go_on = !progress || progress(summary.sweeps, drive.size());
  }
  write_texts(drive, folder, poses);
  write_atomically(folder / kMeta, description(drive, summary));
  take_away(folder / kUnfinished);
  return summary;
}

}  // namespace rilo
