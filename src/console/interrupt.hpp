// Ctrl-C, SIGTERM and a terminal that is closed (SIGHUP) end a run after the current sweep.
#pragma once

namespace rilo {

/// Installs handlers for SIGINT, SIGTERM and, unless the program was started with it ignored (nohup), SIGHUP while it
/// lives. A second signal ends the program at once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// The signal that came, 0 when none did.
  static int signal();

  /// Signals end the program at once again: for a child process whose work is not worth finishing.
  static void release();

  /// Until one comes.
  static void wait();
};

}  // namespace rilo
