// What the command line of `rilo run` says.
#pragma once

#include <string>
#include <vector>

#include "results/run_request.hpp"
#include "view/viewer.hpp"

namespace rilo::cli {

struct RunFlags : RunRequest, OutputRequest {
  std::string config_file;
  std::vector<std::string> settings;
  int threads = -1;  ///< -1: as the configuration says
  bool json = false;
  bool no_truth = false;
  std::string view;  ///< --view: its port or "auto"; empty: no viewer
  ViewOptions view_options;
};

}  // namespace rilo::cli
