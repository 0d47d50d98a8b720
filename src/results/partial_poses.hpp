// Poses on disk during the run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "rilo/session/session_observer.hpp"

namespace rilo {

/// `poses_lidar.partial.txt` in the output folder, KITTI form, one line per sweep, handed to the system immediately:
/// even a run that is killed leaves a valid beginning. It goes away when the whole files are in place.
class PartialPoses final : public SessionObserver {
 public:
  /// An empty `folder`: nothing is written.
  explicit PartialPoses(const std::filesystem::path& folder);

  /// @throws RunError, kCannotWrite, when the disk is full; the lines before stay.
  void on_registered(const RegisteredSweep& sweep) override;

  /// Forgets the poses so far. @throws RunError, kCannotWrite
  void on_restart(const Restart& restart) override;

  void remove();

 private:
  void open();

  std::filesystem::path file_;
  std::ofstream stream_;
  std::uintmax_t bytes_ = 0;  // of complete lines
};

}  // namespace rilo
