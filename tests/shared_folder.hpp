// The folder with real recordings and independent scorers; tests that need it are skipped where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace rilo::test {

/// RILO_SHARED, else ../shared.
inline std::filesystem::path shared_folder() {
  const char* told = std::getenv("RILO_SHARED");
  return told != nullptr ? std::filesystem::path(told)
                         : std::filesystem::path(RILO_SOURCE_DIR).parent_path() / "shared";
}

}  // namespace rilo::test
