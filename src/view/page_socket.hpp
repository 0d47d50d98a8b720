// One page's connection.
#pragma once

#include <atomic>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "access.hpp"
#include "view_history.hpp"

namespace rilo::view {

class PageSocket;

/// What all connections share. Used by the server's thread, but for the counter.
struct Hub {
  Hub(const ViewInfo& what, const ViewOptions& how, bool loopback)
      : info(what), options(how), access(loopback), history(what, how) {}

  void add(const std::shared_ptr<PageSocket>& socket);

  /// Something new is there to be sent.
  void wake();

  /// Forgets the history and ends all connections: pages come again by themselves and get everything again.
  void start_over();

  ViewInfo info;
  ViewOptions options;
  Access access;
  ViewHistory history;
  std::vector<std::weak_ptr<PageSocket>> sockets;
  std::atomic<std::size_t> clients = 0;
  std::size_t connections = 0;  // those of plain HTTP
};

inline constexpr std::size_t kMaxClients = 8;
inline constexpr std::size_t kMaxConnections = 64;  // a browser opens six

/// Has no queue: it knows how far its page has got and picks the next frame when the last one has left. A page that
/// reads slowly misses sweeps in between, one that does not read is closed when it does not answer pings either.
class PageSocket : public std::enable_shared_from_this<PageSocket> {
 public:
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  PageSocket(boost::beast::tcp_stream stream, Hub& hub);
  ~PageSocket();
  PageSocket(const PageSocket&) = delete;
  PageSocket& operator=(const PageSocket&) = delete;

  /// Answers the upgrade and begins to send.
  void start(const Request& request);
  /// Sends the next frame, if one is due and none is on its way.
  void pump();
  void close();

 private:
  void read();
  void on_read(boost::beast::error_code error, std::size_t bytes);
  void refuse(boost::beast::websocket::close_code code, const std::string& why);
  Frame next_frame();
  Frame next_sweep();
  Frame next_map();

  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  Hub& hub_;
  boost::beast::flat_buffer incoming_;
  Frame outgoing_;  // on its way; null: none
  bool open_ = false;
  bool told_info_ = false;
  std::uint32_t told_records_ = 0;
  std::uint32_t told_epoch_ = 0;
  std::size_t told_map_frames_ = 0;
  std::optional<std::uint32_t> told_sweep_;
  Progress told_progress_;
  bool map_turn_ = false;  // sweeps and map take turns
  bool follow_ = true;
  std::optional<std::uint32_t> wanted_;
};

}  // namespace rilo::view
