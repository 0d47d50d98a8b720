// Everything that the node can be told, from its private parameters.
#pragma once

#include <optional>
#include <string>

#include "rilo/geometry/se3.hpp"
#include "rilo/io/live_queue.hpp"
#include "rilo/io/source_options.hpp"
#include "rilo/odometry/odometry_config.hpp"

namespace ros {
class NodeHandle;
}

namespace rilo::ros1 {

struct NodeOptions {
  OdometryConfig config;
  SourceOptions source;
  LiveQueueOptions queue;
  std::string odom_frame = "odom";
  std::string base_frame;           ///< empty: the LiDAR's own frame, as the messages name it
  std::optional<SE3> T_base_lidar;  ///< unset: looked up in TF, where base_frame is not the LiDAR's
  bool publish_tf = true;
  bool invert_tf = false;         ///< base_frame is the parent
  double path_period_s = 1;       ///< of the sweeps' stamps; 0: at every sweep
  double local_map_period_s = 1;  ///< the same
  double map_voxel_m = 0.2;       ///< of the map of the whole run, for save_map; 0: none is kept
};

/// Reads the parameters of `node` ("~"): those of docs/ros1.md, and any key of the configuration by its name, ~icp/gate
/// or what rosparam loads from a YAML file; single keys count more than the file of ~config.
/// @throws ConfigError, std::invalid_argument: a value of the wrong type or out of range, an unknown name.
NodeOptions read_options(const ros::NodeHandle& node);

}  // namespace rilo::ros1
