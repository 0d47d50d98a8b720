#include "view/viewer.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <unistd.h>
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

}  // namespace

class Viewer::Impl {
 public:
  Impl(const ViewInfo& info, const ViewOptions& options)
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

  ~Impl() {
    thread_.stop([this] { server_.stop(); });
  }

  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  const std::string& url() const { return url_; }

  void push(ViewSweep sweep, bool wait) {
    const bool has_points = !sweep.sweep.points.empty();
    const bool drop = has_points && !take_room(wait);
    if (drop) sweep.sweep = Sweep{};
    // Shared, since handlers of this library's older versions are copied.
    auto shared = std::make_shared<const ViewSweep>(std::move(sweep));
    thread_.post([this, shared = std::move(shared), drop, counted = has_points && !drop] {
      hub_.history.add(*shared, unhurried_ || hub_.clients > 0);
      if (drop) hub_.history.note_dropped();
      hub_.dropped = hub_.history.progress().dropped;
      if (counted) give_room();
      hub_.wake();
    });
  }

  std::vector<std::uint32_t> missing_points() {
    auto missing = std::make_shared<std::optional<std::vector<std::uint32_t>>>();
    thread_.post([this, missing] {
      const std::lock_guard lock(mutex_);
      *missing = hub_.history.choose_missing();
      hub_.dropped = hub_.history.progress().dropped;
      room_.notify_all();
    });
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return missing->has_value() || thread_.failed(); });
    return missing->value_or(std::vector<std::uint32_t>{});
  }

  void fill(std::uint32_t number, ViewSweep sweep) {
    if (!take_room(true)) return;
    auto shared = std::make_shared<const ViewSweep>(std::move(sweep));
    thread_.post([this, number, shared = std::move(shared)] {
      hub_.history.fill(number, *shared, hub_.clients > 0);
      hub_.dropped = hub_.history.progress().dropped;
      give_room();
      hub_.wake();
    });
  }

  void add_map(std::vector<Eigen::Vector3f> points, std::vector<std::uint32_t> sweeps) {
    thread_.post([this, points = std::move(points), sweeps = std::move(sweeps)] {
      hub_.history.add_map(points, sweeps);
      hub_.wake();
    });
  }

  void start_over() {
    thread_.post([this] { hub_.start_over(); });
  }

  void finish() {
    thread_.post([this] {
      hub_.history.finish();
      hub_.wake();
    });
  }

  std::string failure() const { return thread_.failure(); }
  std::size_t clients() const { return hub_.clients; }
  std::size_t dropped() const { return hub_.dropped; }

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
    if (address.is_unspecified()) {
      std::string name(256, '\0');
      if (gethostname(name.data(), name.size() - 1) == 0) host = name.substr(0, name.find('\0'));
    }
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

Viewer::Viewer(const ViewInfo& info, const ViewOptions& options) {
  if (!has_page()) {
    throw IoError({"the viewer", "", "a build without its page",
                   "a build made with npm and the npm registry within reach",
                   "Install nodejs and npm, configure and build again"});
  }
  impl_ = std::make_unique<Impl>(info, options);
}

Viewer::~Viewer() = default;

bool Viewer::has_page() { return !view::page_files().empty(); }

std::string Viewer::url() const { return impl_->url(); }

void Viewer::push(ViewSweep sweep) { impl_->push(std::move(sweep), false); }

void Viewer::push_all(ViewSweep sweep) { impl_->push(std::move(sweep), true); }

std::vector<std::uint32_t> Viewer::missing_points() { return impl_->missing_points(); }

void Viewer::fill(std::uint32_t number, ViewSweep sweep) { impl_->fill(number, std::move(sweep)); }

void Viewer::add_map(std::span<const Eigen::Vector3f> points, std::span<const std::uint32_t> sweeps) {
  impl_->add_map({points.begin(), points.end()}, {sweeps.begin(), sweeps.end()});
}

void Viewer::start_over() { impl_->start_over(); }

void Viewer::finish() { impl_->finish(); }

std::string Viewer::failure() const { return impl_->failure(); }

std::size_t Viewer::clients() const { return impl_->clients(); }

std::size_t Viewer::dropped() const { return impl_->dropped(); }

}  // namespace rilo
