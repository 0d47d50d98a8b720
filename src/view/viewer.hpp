// A web page that shows a run live, or a recorded one: docs/view.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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

/// Serves the page from a thread of its own. Methods are called by one thread.
class Viewer {
 public:
  /// Binds and begins to serve.
  /// @throws IoError: no such address, port taken, or a build without the page.
  Viewer(const ViewInfo& info, const ViewOptions& options);
  /// Ends all connections.
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Whether this build holds the page.
  static bool has_page();

  /// Where to look, with the token where one is needed.
  std::string url() const;

  /// Hands a sweep over; takes microseconds. When the viewer cannot keep up, the sweep's points are dropped, its pose
  /// and statistics never.
  void push(ViewSweep sweep);

  /// The same, but waits until the viewer has room and keeps the points: for replays.
  void push_all(ViewSweep sweep);

  /// Numbers (counted from the first one that was pushed) of sweeps whose points were dropped, ascending: those that
  /// there is room for. Waits until all that was handed over is taken in. Only these count as dropped from now on.
  std::vector<std::uint32_t> missing_points();

  /// Adds the points of one of them; waits until the viewer has room.
  void fill(std::uint32_t number, ViewSweep sweep);

  /// Points of a finished map, odometry frame (m); each appears with the sweep of that number (counted from the first
  /// one that was pushed). Both spans are of the same length.
  void add_map(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> sweeps);

  /// Forgets the sweeps so far: the run restarts. Pages are disconnected, and connect again by themselves.
  void start_over();

  /// No sweep will come any more.
  void finish();

  /// Why it ended early; what is handed over from then on is dropped. Empty: it is running.
  std::string failure() const;

  /// Pages that are connected now.
  std::size_t clients() const;

  /// Sweeps whose points were dropped so far.
  std::size_t dropped() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rilo
