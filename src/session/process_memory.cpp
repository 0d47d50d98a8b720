#include "session/process_memory.hpp"

#include <fstream>
#include <string>
#include <sys/resource.h>

namespace rilo::detail {

namespace {
constexpr double kKibPerMib = 1024.0;
}  // namespace

// Of this program alone: getrusage may give the peak of the process that started it.
double peak_memory_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kib = 0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kib) return kib / kKibPerMib;
  }
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / kKibPerMib;
}

}  // namespace rilo::detail
