// Independent scorers in the folder RILO_SHARED or ../shared: running them and reading what they print.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "rilo/geometry/se3.hpp"
#include "shared_folder.hpp"

namespace rilo::test {

inline std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), &pclose);
  std::string text;
  std::array<char, 512> chunk{};
  while (pipe && fgets(chunk.data(), static_cast<int>(chunk.size()), pipe.get()) != nullptr) text += chunk.data();
  return text;
}

inline bool python_has(const std::string& module) {
  return output_of("/usr/bin/python3 -c 'import " + module + "; print(1)' 2>&1") == "1\n";
}

/// Figures by name, from the one line of JSON that `command` prints.
inline std::map<std::string, double> peer_figures(const std::string& command) {
  std::string text = output_of(command);
  for (char& c : text) c = c == '{' || c == '}' || c == '"' || c == ':' || c == ',' ? ' ' : c;
  std::istringstream words(text);
  std::map<std::string, double> figures;
  std::string name;
  double value = 0;
  while (words >> name >> value) figures[name] = value;
  return figures;
}

/// KITTI form, all digits.
inline std::filesystem::path write_poses(const std::filesystem::path& path, const std::vector<SE3>& poses) {
  std::ofstream file(path);
  file << std::setprecision(17);
  for (const SE3& T : poses) {
    for (int i = 0; i < 12; ++i) file << T.matrix()(i / 4, i % 4) << (i == 11 ? '\n' : ' ');
  }
  return path;
}

}  // namespace rilo::test
