// A web page that shows a run live, or a recorded one: docs/view.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "view/view_sweep.hpp"

namespace rilo {

struct ViewOptions {
  std::string address = "127.0.0.1";     ///< numeric; anything but a loopback address needs the token of url()
  std::optional<std::uint16_t> port;     ///< 0: a free one; nothing: the usual one, or a free one where that is taken
  std::size_t map_points = 1'000'000;    ///< the map gets coarser rather than larger
  std::size_t sweep_points = 16'000;     ///< shown of one sweep
  std::size_t sweep_bytes = 96U << 20U;  ///< of sweeps kept for looking back; of more, every second one goes
  double share = 0.05;                   ///< of one processor that may go into points; 1: no limit
};

/// The port that is taken when none is asked for.
inline constexpr std::uint16_t kViewPort = 7456;

/// Serves the page from a thread of its own until it is destroyed. Methods are called by one thread.
class Viewer {
 public:
  virtual ~Viewer() = default;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Where to look, with the token where one is needed.
  virtual const std::string& url() const = 0;

  /// Hands a sweep over. When the viewer cannot keep up, the sweep's points are dropped, its pose and statistics never:
  /// then it takes microseconds beside the copy of the sweep. With `wait` they are kept, and it waits until the viewer
  /// has room: for replays.
  virtual void push(ViewSweep sweep, bool wait) = 0;

  /// Numbers (counted from the first one that was pushed) of sweeps whose points were dropped, ascending: those that
  /// there is room for. Waits until all that was handed over is taken in. Only these count as dropped from now on.
  virtual std::vector<std::uint32_t> missing_points() = 0;

  /// Adds the points of one of them; waits until the viewer has room.
  virtual void fill(std::uint32_t number, ViewSweep sweep) = 0;

  /// Points of a finished map, odometry frame (m); each appears with the sweep of that number (counted from the first
  /// one that was pushed). Both are of the same length.
  virtual void add_map(std::vector<Eigen::Vector3f> points, std::vector<std::uint32_t> sweeps) = 0;

  /// Forgets the sweeps so far: the run restarts. Pages are disconnected, and connect again by themselves.
  virtual void start_over() = 0;

  /// No sweep will come any more.
  virtual void finish() = 0;

  /// Why it ended early; what is handed over from then on is dropped. Empty: it is running.
  virtual std::string failure() const = 0;

 protected:
  Viewer() = default;
};

/// Binds and begins to serve.
/// @throws IoError: no such address, port taken, or a build without the page.
std::unique_ptr<Viewer> open_viewer(const ViewInfo& info, const ViewOptions& options);

}  // namespace rilo
