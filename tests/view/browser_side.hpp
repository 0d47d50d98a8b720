// The server without the viewer around it, and a browser's side of the connection.
#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdlib>
#include <future>
#include <string>
#include <thread>

#include "page_server.hpp"

namespace rilo::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;

/// The server on a free port of this machine, without the thread and the page of Viewer.
class Server {
 public:
  explicit Server(const std::string& address = "127.0.0.1", bool loopback = true)
      : hub_(ViewInfo{}, options(), loopback), server_(io_, address, 0, hub_) {
    server_.start();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~Server() {
    asio::post(io_, [this] {
      server_.stop();
      io_.stop();
    });
    thread_.join();
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  unsigned short port() const { return server_.endpoint().port(); }
  std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
  Hub& hub() { return hub_; }
  std::size_t pauses() const { return server_.pauses(); }

  void add(std::size_t sweeps, std::size_t points = 100) {
    asio::post(io_, [this, sweeps, points] {
      for (std::size_t i = 0; i < sweeps; ++i) {
        ViewSweep sweep;
        sweep.index = hub_.history.records();
        sweep.result.status = OdometryStatus::kOk;
        for (std::size_t k = 0; k < points; ++k) {
          sweep.sweep.points.emplace_back(5.0F + static_cast<float>(k % 97), static_cast<float>(k % 89), 0.5F);
        }
        hub_.history.add(sweep, true);
      }
      hub_.wake();
    });
  }

  /// Pages that the hub knows of, gone or not.
  std::size_t known_pages() {
    std::promise<std::size_t> known;
    asio::post(io_, [&] { known.set_value(hub_.sockets.size()); });
    return known.get_future().get();
  }

  void start_over() {
    asio::post(io_, [this] { hub_.start_over(); });
  }

 private:
  static ViewOptions options() {
    ViewOptions options;
    options.share = 1.0;
    return options;
  }

  Hub hub_;
  asio::io_context io_{1};  // what waits in it counts in the hub to its end
  PageServer server_;
  std::thread thread_;
};

inline tcp::socket connect(asio::io_context& io, const Server& server) {
  tcp::socket socket(io);
  socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  return socket;
}

/// What the server answers to raw bytes, up to the end of the connection.
inline std::string answer(const Server& server, const std::string& bytes) {
  asio::io_context io;
  tcp::socket socket = connect(io, server);
  boost::system::error_code error;
  asio::write(socket, asio::buffer(bytes), error);
  socket.shutdown(tcp::socket::shutdown_send, error);
  std::string text;
  asio::read(socket, asio::dynamic_buffer(text), error);
  return text;
}

/// The status of that answer, 0 when there is none.
inline int status(const Server& server, const std::string& bytes) {
  const std::string text = answer(server, bytes);
  const std::size_t space = text.find(' ');
  return space == std::string::npos ? 0 : std::atoi(text.c_str() + space);
}

inline std::string get(const std::string& target, const std::string& host, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
}

inline std::string upgrade(const std::string& origin) {
  return (origin.empty() ? "" : "Origin: " + origin + "\r\n") +
         "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
}

/// A page's side of the connection.
class Page {
 public:
  explicit Page(const Server& server, const std::string& target = "/ws") : socket_(connect(io_, server)) {
    const std::string origin = "http://" + server.host();
    socket_.set_option(websocket::stream_base::decorator(
        [origin](websocket::request_type& request) { request.set(http::field::origin, origin); }));
    socket_.handshake(server.host(), target);
    socket_.binary(true);
  }

  /// Frames until one of `type`; that one.
  Bytes until(FrameType type) {
    while (true) {
      Bytes frame = read();
      if (frame.empty() || frame[0] == static_cast<std::uint8_t>(type)) return frame;
    }
  }

  /// Empty: the connection is closed.
  Bytes read() {
    beast::flat_buffer buffer;
    boost::system::error_code error;
    socket_.read(buffer, error);
    if (error) return {};
    const auto* begin = static_cast<const std::uint8_t*>(buffer.data().data());
    return {begin, begin + buffer.size()};
  }

  void send(const Bytes& message) {
    boost::system::error_code error;
    socket_.write(asio::buffer(message), error);
  }
  void send_text(const std::string& text) {
    socket_.text(true);
    boost::system::error_code error;
    socket_.write(asio::buffer(text), error);
  }
  /// Reads what is left; the reason of the end.
  websocket::close_code end() {
    while (!read().empty()) {
    }
    return static_cast<websocket::close_code>(socket_.reason().code);
  }

 private:
  asio::io_context io_;
  websocket::stream<tcp::socket> socket_;
};

}  // namespace rilo::view
