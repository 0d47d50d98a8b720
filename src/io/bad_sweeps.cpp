#include "io/bad_sweeps.hpp"

#include "io/text.hpp"

namespace rilo::detail {

void note_bad_sweep(const IoError& error, SourceInfo& info, std::size_t sweeps) {
  constexpr std::size_t kMostMessages = 20;
  if (info.bad_sweeps < kMostMessages) info.warnings.push_back(std::string("skipped: ") + error.what());
  info.bad_sweeps += sweeps;
}

void add_bad_sweep_count(SourceInfo& info) {
  if (info.bad_sweeps == 0) return;
  info.warnings.push_back(counted(info.bad_sweeps, "sweep") + " could not be read and " +
                          (info.bad_sweeps == 1 ? "was" : "were") + " skipped");
}

}  // namespace rilo::detail
