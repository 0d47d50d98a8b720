// CLI11's parser by name: its headers take seconds to compile, and only what adds options needs them.
#pragma once

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's name
class App;
}
