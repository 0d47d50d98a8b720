// What is to be run, and what of it is to be kept.
#pragma once

#include <cstddef>
#include <string>

#include "rilo/cloud/sweep.hpp"
#include "rilo/io/source_options.hpp"
#include "rilo/session/session.hpp"

namespace rilo {

/// How data are read.
struct SourceRequest {
  SourceOptions options;
  bool times_needed = false;  ///< sweeps without point times are an error
};

/// @throws RunError, kBadData, when the sweep of that name lacks the point times that are needed.
void check_point_times(const SourceRequest& request, const Sweep& sweep, const std::string& name);

struct RunRequest {
  std::string data;
  std::size_t start = 0;
  std::size_t count = 0;  ///< 0: all
  bool one_pass = false;
  std::string calibration;     ///< file of a sensor's angles; empty: none
  bool map_intensity = false;  ///< intensities are needed
  bool quiet = false;          ///< neither progress nor warnings
  SourceRequest source;
};

/// Opens request.data, for as many passes as there will be.
OpenSource source_of(const RunRequest& request);

/// The run that the request describes, ended by the signals of InterruptGuard.
SessionOptions session_options(const RunRequest& request, const OdometryConfig& config);

/// Files that a run leaves behind.
struct OutputRequest {
  std::string out;          ///< folder; empty: none
  std::string map;          ///< file of the map; empty: none
  std::string odom_frame;   ///< empty: "odom"
  std::string lidar_frame;  ///< empty: the data's frame_id, or "lidar" where it has none
  double map_voxel_m = 0.2;
  bool map_normals = false;
  bool no_report = false;
};

}  // namespace rilo
