#include "io/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "rilo/io/io_error.hpp"

namespace rilo::detail {

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::string pattern = (std::filesystem::temp_directory_path() / (name + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    throw IoError({pattern, "", "cannot be made: " + std::generic_category().message(errno), "a temporary folder",
                   "Set TMPDIR to a folder that may be written to"});
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace rilo::detail
