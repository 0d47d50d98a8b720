#include "bench_process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>
#include <iostream>
#include <optional>
#include <poll.h>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <fmt/format.h>

#include "interrupt.hpp"

namespace rilo::cli {

namespace {

constexpr int kLookForSignalsMs = 200;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

// Nothing of the child is worth finishing: signals end it at once.
void become_child(pid_t parent) {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kUnexpected);
#endif
}

bool send_all(int to, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::write(to, bytes.data() + sent, bytes.size() - sent);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
  return true;
}

// All that the child says; nothing when a signal came first.
std::optional<std::string> receive(int from) {
  std::string bytes;
  std::array<char, std::size_t{1} << 16> buffer{};
  while (InterruptGuard::signal() == 0) {
    pollfd waiting{from, POLLIN, 0};
    if (poll(&waiting, 1, kLookForSignalsMs) <= 0) continue;
    const ssize_t count = read(from, buffer.data(), buffer.size());
    if (count == 0) return bytes;
    if (count > 0) bytes.append(buffer.data(), static_cast<std::size_t>(count));
    if (count < 0 && errno != EINTR) return bytes;
  }
  return std::nullopt;
}

int end_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string reason_of(int status) {
  if (!WIFSIGNALED(status))
    return fmt::format("its process ended with code {} and left no result", WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  return fmt::format("its process was ended by signal {} ({}){}", signal, strsignal(signal),
                     signal == SIGKILL ? "; the memory may be exhausted" : "");
}

std::vector<BenchCell> parsed(const std::string& bytes) {
  std::vector<BenchCell> cells;
  for (const auto& cell : nlohmann::json::parse(bytes)) cells.push_back(unpacked(cell));
  return cells;
}

// No exception may get out: the child would go on as if it were the parent.
template <typename Work>
[[noreturn]] void work_and_exit(int to, const Work& work) {
  try {
    nlohmann::json cells = nlohmann::json::array();
    for (const BenchCell& cell : work()) cells.push_back(packed(cell));
    const bool sent = send_all(to, cells.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    _exit(sent ? kSuccess : kUnexpected);
  } catch (...) {
    _exit(kUnexpected);
  }
}

nlohmann::json packed_kitti(const KittiError& error) {
  nlohmann::json segments = nlohmann::json::array();
  for (const KittiSegment& s : error.segments) {
    segments.push_back({s.first, s.last, s.length_m, s.t_err, s.r_err_rad_per_m});
  }
  return {{"short_path", error.short_path}, {"segments", segments}};
}

KittiError unpacked_kitti(const nlohmann::json& json) {
  KittiError error;
  error.short_path = json.at("short_path");
  for (const auto& s : json.at("segments")) error.segments.push_back({s.at(0), s.at(1), s.at(2), s.at(3), s.at(4)});
  return error;
}

}  // namespace

nlohmann::json packed(const BenchCell& cell) {
  nlohmann::json json = {{"sequence", cell.sequence},
                         {"configuration", cell.configuration},
                         {"peer", cell.peer},
                         {"settings", cell.settings},
                         {"metrics", cell.metrics},
                         {"error", cell.error},
                         {"error_code", static_cast<int>(cell.error_code)}};
  if (cell.kitti) json["kitti"] = packed_kitti(*cell.kitti);
  return json;
}

BenchCell unpacked(const nlohmann::json& json) {
  BenchCell cell{json.at("sequence"), json.at("configuration"),
                 json.at("peer"),     json.at("settings"),
                 json.at("metrics"),  std::nullopt,
                 json.at("error"),    static_cast<ExitCode>(json.at("error_code").get<int>())};
  if (json.contains("kitti")) cell.kitti = unpacked_kitti(json["kitti"]);
  return cell;
}

std::vector<BenchCell> run_cell_apart(const BenchSequence& sequence, const BenchConfiguration& configuration,
                                      const BenchRunFlags& flags, bool with_peers) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  Descriptor from(ends[0]);
  Descriptor to(ends[1]);
  std::cout.flush();
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    from.close();
    become_child(parent);
    work_and_exit(to.number(), [&] { return run_cell(sequence, configuration, flags, with_peers); });
  }
  to.close();
  const auto bytes = receive(from.number());
  if (!bytes) kill(child, SIGKILL);
  const int status = end_of(child);
  // Ctrl-C goes to both; the child may be gone before we notice our own.
  if (!bytes || (WIFSIGNALED(status) && InterruptGuard::signal() != 0)) return {};
  if (status == 0) return parsed(*bytes);
  return {{sequence.name, configuration.name, false, configuration.settings, {}, {}, reason_of(status), kUnexpected}};
}

}  // namespace rilo::cli
