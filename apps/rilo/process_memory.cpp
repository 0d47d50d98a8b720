#include "process_memory.hpp"

#include <fstream>
#include <malloc.h>
#include <string>
#include <sys/resource.h>

namespace rilo::cli {

// Of this program alone: getrusage may give the peak of the process that started it.
double peak_rss_mb() {
  std::ifstream status("/proc/self/status");
  std::string word;
  double kib = 0;
  while (status >> word) {
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

void restart_peak_rss() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets VmHWM
}

}  // namespace rilo::cli
