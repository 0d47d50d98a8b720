// Listens, serves the page, and turns upgrades into sockets.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "page_socket.hpp"

namespace rilo::view {

class PageServer {
 public:
  /// Binds. @throws IoError: the address is no number, the port is taken.
  PageServer(boost::asio::io_context& io, const std::string& address, std::optional<std::uint16_t> port, Hub& hub);

  void start() { accept(); }
  void stop();
  boost::asio::ip::tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

 private:
  void accept();

  Hub& hub_;
  boost::asio::ip::tcp::acceptor acceptor_;
};

/// Whether `address` is this machine alone. @throws IoError when it is no numeric address.
bool is_loopback(const std::string& address);

}  // namespace rilo::view
