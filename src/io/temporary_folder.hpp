// A folder that goes away again.
#pragma once

#include <filesystem>
#include <string>

namespace rilo::detail {

class TemporaryFolder {
 public:
  /// In the system's folder for such things, named after `name`. @throws IoError
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace rilo::detail
