#include "view/viewer.hpp"

#include <boost/asio/ip/host_name.hpp>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "page_files.hpp"
#include "page_server.hpp"
#include "rilo/io/io_error.hpp"
#include "view_thread.hpp"

namespace rilo {

namespace {

constexpr std::size_t kQueue = 4;  // sweeps with points on their way to the viewer's thread

class ServedViewer final : public Viewer {
 public:
  ServedViewer(const ViewInfo& info, const ViewOptions& options)
      : unhurried_(options.share >= 1.0),
        hub_(info, options, view::is_loopback(options.address)),
        server_(thread_.io(), options.address, options.port, hub_) {
    url_ = shown_url();
    server_.start();
    thread_.start(options.share < 1.0, [this] {
      server_.stop();
      const std::lock_guard lock(mutex_);
      room_.notify_all();
    });
  }

  ~ServedViewer() override {
    thread_.stop([this] { server_.stop(); });
  }

  const std::string& url() const override { return url_; }

  void push(ViewSweep sweep, bool wait) override {
    const bool has_points = !sweep.sweep.points.empty();
    const bool drop = has_points && !take_room(wait);
    if (drop) sweep.sweep = Sweep{};
    // Shared, since handlers of this library's older versions are copied.
    auto shared = std::make_shared<const ViewSweep>(std::move(sweep));
    thread_.post([this, shared = std::move(shared), drop, counted = has_points && !drop] {
      hub_.history.add(*shared, unhurried_ || hub_.clients > 0);
      if (drop) hub_.history.note_dropped();
      if (counted) give_room();
      hub_.wake();
    });
  }

  std::vector<std::uint32_t> missing_points() override {
    auto missing = std::make_shared<std::optional<std::vector<std::uint32_t>>>();
    thread_.post([this, missing] {
      const std::lock_guard lock(mutex_);
      *missing = hub_.history.choose_missing();
      room_.notify_all();
    });
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return missing->has_value() || thread_.failed(); });
    return missing->value_or(std::vector<std::uint32_t>{});
  }

  void fill(std::uint32_t number, ViewSweep sweep) override {
    if (!take_room(true)) return;
    auto shared = std::make_shared<const ViewSweep>(std::move(sweep));
    thread_.post([this, number, shared = std::move(shared)] {
      hub_.history.fill(number, *shared, hub_.clients > 0);
      give_room();
      hub_.wake();
    });
  }

  void add_map(std::vector<Eigen::Vector3f> points, std::vector<std::uint32_t> sweeps) override {
    thread_.post([this, points = std::move(points), sweeps = std::move(sweeps)] {
      hub_.history.add_map(points, sweeps);
      hub_.wake();
    });
  }

  void start_over() override {
    thread_.post([this] { hub_.start_over(); });
  }

  void finish() override {
    thread_.post([this] {
      hub_.history.finish();
      hub_.wake();
    });
  }

  std::string failure() const override { return thread_.failure(); }

 private:
  // False when the queue is full.
  bool take_room(bool wait) {
    std::unique_lock lock(mutex_);
    if (wait) room_.wait(lock, [this] { return waiting_ < kQueue || thread_.failed(); });
    if (waiting_ >= kQueue) return false;
    ++waiting_;
    return true;
  }

  void give_room() {
    const std::lock_guard lock(mutex_);
    --waiting_;
    room_.notify_one();
  }

  std::string shown_url() const {
    const auto endpoint = server_.endpoint();
    const auto address = endpoint.address();
    std::string host = address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
    if (address.is_unspecified()) host = boost::asio::ip::host_name();
    const std::string& token = hub_.access.token();
    return fmt::format("http://{}:{}/{}", host, endpoint.port(), token.empty() ? "" : "?token=" + token);
  }

  bool unhurried_;  // residuals also without a page connected
  view::Hub hub_;
  view::ViewThread thread_;
  view::PageServer server_;
  std::string url_;
  std::mutex mutex_;
  std::condition_variable room_;
  std::size_t waiting_ = 0;
};

}  // namespace

std::unique_ptr<Viewer> open_viewer(const ViewInfo& info, const ViewOptions& options) {
  if (view::page_files().empty()) {
    throw IoError({"the viewer", "", "a build without its page",
                   "a build made with npm and the npm registry within reach",
                   "Install nodejs and npm, configure and build again"});
  }
  return std::make_unique<ServedViewer>(info, options);
}

}  // namespace rilo
