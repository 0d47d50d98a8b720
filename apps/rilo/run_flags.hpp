// Options of `rilo run`.
#pragma once

#include <string>
#include <vector>

#include "results/run_request.hpp"
#include "view/viewer.hpp"

namespace rilo::cli {

struct RunFlags : RunRequest, OutputRequest {
  std::string config_file;
  std::vector<std::string> settings;
  int threads = -1;  ///< -1: as configured
  bool json = false;
  bool no_truth = false;
  bool real_time = false;  ///< no faster than recorded
  std::string view;        ///< --view: its port or "auto"; empty: no viewer
  ViewOptions view_options;
};

}  // namespace rilo::cli
