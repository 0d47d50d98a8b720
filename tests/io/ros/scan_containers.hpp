// One recording in every container, for messages of any type.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/io_test_util.hpp"
#include "io/ros/ros_bytes.hpp"

namespace rilo::test {

/// Type and bytes are asked for in both encodings: `ros1` is true for ROS 1.
struct TopicInBoth {
  std::string name;
  std::string package;
  std::string type;

  std::string full_type(bool ros1) const { return package + (ros1 ? "/" : "/msg/") + type; }
};

/// Writes what `messages(ros1)` gives as MCAP of both encodings, rosbag2 (SQLite3 and MCAP) and, where the build has
/// librosbag-storage, as a ROS 1 bag; returns the paths.
template <typename Messages>
std::vector<std::filesystem::path> in_every_container(const TempDir& folder, const std::vector<TopicInBoth>& topics,
                                                      Messages&& messages) {
  const auto typed = [&](bool ros1) {
    Topics all;
    for (const TopicInBoth& topic : topics) all.emplace_back(topic.name, topic.full_type(ros1));
    return all;
  };
  McapShape ros1_shape{"lz4", 2, true};
  ros1_shape.encoding = "ros1";
  std::vector<std::filesystem::path> paths{
      folder.write("ros1.mcap", mcap_bytes(typed(true), messages(true), ros1_shape)),
      folder.write("ros2.mcap", mcap_bytes(typed(false), messages(false), {"zstd", 2, true}))};
  write_db3(folder.write("db3/db3_0.db3", ""), typed(false), messages(false));
  folder.write("db3/metadata.yaml", metadata_yaml({"db3_0.db3"}, "sqlite3"));
  paths.push_back(folder / "db3");
  folder.write("mcap/mcap_0.mcap", mcap_bytes(typed(false), messages(false), {}));
  folder.write("mcap/metadata.yaml", metadata_yaml({"mcap_0.mcap"}, "mcap"));
  paths.push_back(folder / "mcap");
#ifdef RILO_HAS_ROSBAG
  write_bag(folder / "ros1.bag", typed(true), messages(true), "lz4");
  paths.push_back(folder / "ros1.bag");
#endif
  return paths;
}

}  // namespace rilo::test
