// This build has no page.
#include "page_files.hpp"

namespace rilo::view {

std::span<const PageFile> page_files() { return {}; }

}  // namespace rilo::view
