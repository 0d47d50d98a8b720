// Listens, serves the page, and turns upgrades into sockets.
#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "page_socket.hpp"

namespace rilo::view {

/// Until the next attempt where a connection could not be taken.
inline constexpr std::chrono::milliseconds kAcceptPause{200};

class PageServer {
 public:
  /// Binds. @throws IoError: the address is not a number, the port is taken.
  PageServer(boost::asio::io_context& io, const std::string& address, std::optional<std::uint16_t> port, Hub& hub);

  void start() { accept(); }
  void stop();
  boost::asio::ip::tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }
  /// How often a connection could not be taken.
  std::size_t pauses() const { return pauses_; }

 private:
  void accept();
  void pause();

  Hub& hub_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer pause_;
  std::atomic<std::size_t> pauses_ = 0;
};

/// Whether `address` is this machine alone. @throws IoError when it is not a numeric address.
bool is_loopback(const std::string& address);

}  // namespace rilo::view
