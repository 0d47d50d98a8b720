#include "console/interrupt.hpp"

#include <chrono>
#include <csignal>
#include <thread>

namespace rilo {

namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int number) { received = number; }

void install(int number) {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  // SA_RESETHAND: a second Ctrl-C ends a program that hangs.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

// nohup's: who starts a program so wants it to outlive the terminal.
bool ignores_hangup() {
  struct sigaction action = {};
  return sigaction(SIGHUP, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  received = 0;
  install(SIGINT);
  install(SIGTERM);
  if (!ignores_hangup()) install(SIGHUP);
  // A reader of our messages that goes away (`| head`) must not take the results with it.
  std::signal(SIGPIPE, SIG_IGN);
}

InterruptGuard::~InterruptGuard() {
  release();
  std::signal(SIGPIPE, SIG_DFL);
}

void InterruptGuard::release() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  if (!ignores_hangup()) std::signal(SIGHUP, SIG_DFL);
}

int InterruptGuard::signal() { return received; }

void InterruptGuard::wait() {
  while (received == 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

}  // namespace rilo
