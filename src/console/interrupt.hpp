// Ctrl-C and SIGTERM end a run after the current sweep.
#pragma once

namespace rilo {

/// Installs handlers for SIGINT and SIGTERM while it lives. A second signal ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// The signal that came, 0 when none did.
  static int signal();

  /// Until one comes.
  static void wait();
};

}  // namespace rilo
