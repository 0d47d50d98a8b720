// The options of the node, from its private parameters.
#pragma once

#include "rilo/node/node_parameters.hpp"

namespace ros {
class NodeHandle;
}

namespace rilo::ros1 {

/// Reads the parameters of `node` ("~"): those of docs/ros1.md, and any key of the configuration by its name, ~icp/gate
/// or what rosparam loads from a YAML file. @throws as rilo::node_options().
NodeOptions read_options(const ros::NodeHandle& node);

}  // namespace rilo::ros1
