// Everything that a node of ROS 1 or ROS 2 can be told. Like all headers of this folder C++17, as ROS 1's need it.
#pragma once

#include <string>
#include <vector>

#include "rilo/io/source_options.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace rilo {

/// NodeParameters is the table of names, ranges and meanings.
struct NodeOptions {
  std::string config_file;  ///< already in `config`
  OdometryConfig config;
  SourceOptions source;
  int queue = 2;        ///< LiveQueueOptions::limit
  int look_ahead = 12;  ///< LiveQueueOptions::look_ahead
  std::string odom_frame = "odom";
  std::string base_frame;             ///< empty: the LiDAR's own frame, as the messages name it
  std::vector<double> base_to_lidar;  ///< see pose_from_list(); empty: looked up in TF, where base_frame is another
  bool publish_tf = true;
  bool invert_tf = false;          ///< base_frame is the parent
  double path_period_s = 1;        ///< of the sweeps' stamps; 0: at every sweep
  double local_map_period_s = 1;   ///< the same
  double map_voxel_m = 0.2;        ///< of the map of the whole run, for save_map; 0: none is kept
  double diagnostic_period_s = 1;  ///< of wall time
};

}  // namespace rilo
