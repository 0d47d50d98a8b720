// Takes the place of ROS 1's libroslib inside a wheel. librosbag_storage asks it where its own plugin lies (every bag
// is opened through one, encrypted or not) and for nothing else. The real one searches an installed ROS, and brings
// librospack, Boost's libraries and one fixed libpython along, which no other Python could load. Built by
// scripts/wheel.sh; the plugin with its description lies in rilo/rosbag_storage.
#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <vector>

#define RILO_EXPORTED __attribute__((visibility("default")))

namespace ros::package {

/// Folder of the package rosbag_storage; no other is asked for.
RILO_EXPORTED std::string getPath(const std::string& package);
/// Descriptions of its plugins.
RILO_EXPORTED void getPlugins(const std::string& package, const std::string& attribute,
                              std::vector<std::string>& plugins, bool force_recrawl);

std::string getPath(const std::string& package) {
  Dl_info self{};
  if (dladdr(reinterpret_cast<const void*>(&getPath), &self) == 0) return {};
  const std::filesystem::path libraries = std::filesystem::absolute(self.dli_fname).parent_path();  // rilo.libs
  return (libraries.parent_path() / "rilo" / package).string();
}

void getPlugins(const std::string& package, const std::string& /*attribute*/, std::vector<std::string>& plugins,
                bool /*force_recrawl*/) {
  plugins = {getPath(package) + "/encryptor_plugins.xml"};
}

}  // namespace ros::package
