#include "cli/drives.hpp"

#include <algorithm>
#include <stdexcept>

namespace rilo::test {

namespace fs = std::filesystem;

const fs::path& shared_drive() {
  static const TempDir kFolder;
  static const fs::path kDrive = [] {
    fs::path made = kFolder / "drive";
    const Outcome outcome = rilo_command({"simulate", "--out", made, "--sensor", "vlp16", "--start", "10", "--sweeps",
                                          std::to_string(kDriveSweeps), "--quiet"});
    if (outcome.exit_code != 0) throw std::runtime_error("no drive: " + outcome.err);
    return made;
  }();
  return kDrive;
}

fs::path copy_of_drive(const TempDir& folder) {
  fs::path copy = folder / "drive";
  fs::copy(shared_drive(), copy, fs::copy_options::recursive);
  return copy;
}

fs::path long_folder(const TempDir& folder, std::size_t sweeps) {
  fs::path made = folder / "long";
  fs::create_directory(made);
  constexpr std::size_t kPeriod = 2 * (kDriveSweeps - 1);
  for (std::size_t i = 0; i < sweeps; ++i) {
    const std::size_t phase = i % kPeriod;
    fs::create_symlink(sweep_file(shared_drive(), std::min(phase, kPeriod - phase)),
                       made / (std::to_string(i) + ".bin"));
  }
  return made;
}

fs::path sweep_file(const fs::path& drive, std::size_t index) {
  const std::string number = std::to_string(index);
  return drive / "velodyne" / (std::string(6 - number.size(), '0') + number + ".bin");
}

void append(const fs::path& file, std::size_t bytes) {
  std::ofstream stream(file, std::ios::binary | std::ios::app);
  stream << std::string(bytes, '\x01');
}

void replace(const fs::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << bytes;
}

std::size_t complete_lines(const fs::path& file) {
  const std::string text = fs::exists(file) ? slurp(file) : "";
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

nlohmann::json json_file(const fs::path& file) { return nlohmann::json::parse(slurp(file)); }

}  // namespace rilo::test
