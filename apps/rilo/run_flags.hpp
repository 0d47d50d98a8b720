// What the command line of `rilo run` says.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "rilo/view/viewer.hpp"
#include "source_flags.hpp"

namespace rilo::cli {

struct RunFlags {
  std::string data;
  std::string config_file;
  std::vector<std::string> settings;
  std::string out;
  std::string map;
  double map_voxel_m = 0.2;
  bool map_normals = false;
  bool map_intensity = false;
  std::size_t start = 0;
  std::size_t count = 0;  ///< 0: all
  int threads = -1;       ///< -1: as the configuration says
  bool quiet = false;
  bool json = false;
  bool no_report = false;
  bool no_truth = false;
  bool one_pass = false;
  std::string view;  ///< --view: its port or "auto"; empty: no viewer
  ViewOptions view_options;
  SourceFlags source;
};

}  // namespace rilo::cli
