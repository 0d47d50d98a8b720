#include "view_flags.hpp"

#include <CLI/CLI.hpp>

#include "checks.hpp"

namespace rilo::cli {

void add_address_flag(CLI::App& command, const std::string& name, ViewOptions& options) {
  command
      .add_option(name, options.address,
                  "numeric address to serve the viewer on. Anything but a loopback address can be reached from other "
                  "machines, unencrypted: the address printed then holds a token")
      ->check(path_given())
      ->capture_default_str();
}

}  // namespace rilo::cli
