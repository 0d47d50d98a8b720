// The page, as Vite built it: gzip-packed files inside the program.
#pragma once

#include <span>
#include <string_view>

namespace rilo::view {

struct PageFile {
  std::string_view path;  ///< "/viewer.js"; "/" is the page itself
  std::string_view type;
  std::string_view gzip;
};

/// Empty in a build without npm.
std::span<const PageFile> page_files();

}  // namespace rilo::view
