// This build has no viewer.
#include "rilo/io/io_error.hpp"
#include "view/viewer.hpp"

namespace rilo {

std::unique_ptr<Viewer> open_viewer(const ViewInfo& /*info*/, const ViewOptions& /*options*/) {
  throw IoError(
      {"the viewer", "", "a build without it", "a build with Boost.Beast",
       "Run: apt-get install libboost-dev nodejs npm; cmake --preset command; cmake --build --preset command"});
}

}  // namespace rilo
