#include "view_flags.hpp"

#include <chrono>
#include <thread>

#include <CLI/CLI.hpp>

#include "checks.hpp"
#include "console/interrupt.hpp"

namespace rilo::cli {

void wait_for_signal() {
  while (InterruptGuard::signal() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

void add_address_flag(CLI::App& command, const std::string& name, ViewOptions& options) {
  command
      .add_option(name, options.address,
                  "numeric address to serve the viewer on. Anything but a loopback address can be reached from other "
                  "machines, unencrypted: the address printed then holds a token")
      ->check(path_given())
      ->capture_default_str();
}

}  // namespace rilo::cli
