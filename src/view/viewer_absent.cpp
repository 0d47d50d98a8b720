// This build has no viewer.
#include "rilo/io/io_error.hpp"
#include "view/viewer.hpp"

namespace rilo {

class Viewer::Impl {};

Viewer::Viewer(const ViewInfo& /*info*/, const ViewOptions& /*options*/) {
  throw IoError(
      {"the viewer", "", "a build without it", "a build with Boost.Beast",
       "Run: apt-get install libboost-dev nodejs npm; cmake --preset command; cmake --build --preset command"});
}
Viewer::~Viewer() = default;
bool Viewer::has_page() { return false; }
std::string Viewer::url() const { return {}; }
void Viewer::push(ViewSweep /*sweep*/) {}
void Viewer::push_all(ViewSweep /*sweep*/) {}
std::vector<std::uint32_t> Viewer::missing_points() { return {}; }
void Viewer::fill(std::uint32_t /*number*/, ViewSweep /*sweep*/) {}
void Viewer::add_map(std::span<const Eigen::Vector3f> /*points*/, std::span<const std::uint32_t> /*sweeps*/) {}
void Viewer::start_over() {}
void Viewer::finish() {}
std::string Viewer::failure() const { return {}; }
std::size_t Viewer::clients() const { return 0; }
std::size_t Viewer::dropped() const { return 0; }

}  // namespace rilo
