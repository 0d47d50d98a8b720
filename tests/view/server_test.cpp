// The server as a browser meets it, and as somebody who means harm does.
#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "page_server.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::view {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using namespace std::chrono_literals;

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

  void start_over() {
    asio::post(io_, [this] { hub_.start_over(); });
  }

 private:
  static ViewOptions options() {
    ViewOptions options;
    options.share = 1.0;
    return options;
  }

  asio::io_context io_{1};
  Hub hub_;
  PageServer server_;
  std::thread thread_;
};

tcp::socket connect(asio::io_context& io, const Server& server) {
  tcp::socket socket(io);
  socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
  return socket;
}

/// What the server answers to raw bytes, up to the end of the connection.
std::string answer(const Server& server, const std::string& bytes) {
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
int status(const Server& server, const std::string& bytes) {
  const std::string text = answer(server, bytes);
  const std::size_t space = text.find(' ');
  return space == std::string::npos ? 0 : std::atoi(text.c_str() + space);
}

std::string get(const std::string& target, const std::string& host, const std::string& more = "") {
  return "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n" + more + "\r\n";
}

std::string upgrade(const std::string& origin) {
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

std::uint32_t u32(const Bytes& bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (at + 4 <= bytes.size()) std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

Bytes ask_sweep(std::uint32_t number) {
  Bytes message = {1, 1, 0, 0, 0, 0, 0, 0};
  std::memcpy(message.data() + 4, &number, 4);
  return message;
}

/// Takes every file descriptor that this process may still have.
class NoDescriptors {
 public:
  NoDescriptors() {
    getrlimit(RLIMIT_NOFILE, &before_);
    rlimit few = before_;
    few.rlim_cur = std::min<rlim_t>(few.rlim_cur, 256);
    setrlimit(RLIMIT_NOFILE, &few);
    for (int taken = dup(0); taken >= 0; taken = dup(0)) taken_.push_back(taken);
  }
  ~NoDescriptors() {
    for (const int taken : taken_) close(taken);
    setrlimit(RLIMIT_NOFILE, &before_);
  }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;

 private:
  rlimit before_{};
  std::vector<int> taken_;
};

TEST(ViewServer, WithoutFileDescriptorsItWaitsAndThenGoesOn) {
  const Server server;
  asio::io_context io;
  tcp::socket socket(io, tcp::v4());  // while there are some
  {
    const NoDescriptors none;
    const auto begin = std::chrono::steady_clock::now();
    socket.connect({asio::ip::make_address("127.0.0.1"), server.port()});
    while (server.pauses() < 3) std::this_thread::sleep_for(10ms);
    const auto most = (std::chrono::steady_clock::now() - begin) / kAcceptPause + 1;
    EXPECT_LE(server.pauses(), static_cast<std::size_t>(most));  // it does not spin
  }
  asio::write(socket, asio::buffer(get("/nothing", server.host())));
  boost::system::error_code error;
  std::string text;
  asio::read(socket, asio::dynamic_buffer(text), error);
  EXPECT_NE(text.find("404"), std::string::npos) << text;
}

TEST(ViewServer, APageThatComesLateGetsEverything) {
  Server server;
  server.add(3000);
  Page page(server);
  EXPECT_EQ(page.read().at(0), 1U);
  std::uint32_t records = 0;
  while (records < 3000) {
    const Bytes frame = page.until(FrameType::kRecords);
    ASSERT_FALSE(frame.empty());
    ASSERT_EQ(u32(frame, 8), records);
    records += u32(frame, 4);
  }
  EXPECT_EQ(u32(page.until(FrameType::kSweep), 8), 2999U);
  page.send(ask_sweep(17));
  while (u32(page.until(FrameType::kSweep), 8) != 17U) {
  }
}

TEST(ViewServer, ARunThatStartsOverIsShownFromItsFirstSweep) {
  Server server;
  server.add(300);
  Page page(server);
  ASSERT_FALSE(page.until(FrameType::kRecords).empty());
  server.start_over();
  while (!page.read().empty()) {
  }
  server.add(5);
  Page again(server);
  const Bytes frame = again.until(FrameType::kRecords);
  ASSERT_FALSE(frame.empty());
  EXPECT_EQ(u32(frame, 8), 0U);
  EXPECT_LE(u32(frame, 4), 5U);
}

TEST(ViewServer, OtherOriginsAndHostsAreTurnedAway) {
  Server server;
  for (const char* origin : {"http://evil.example", "", "null"}) {
    EXPECT_EQ(status(server, get("/ws", server.host(), upgrade(origin))), 403) << origin;
  }
  // DNS rebinding: origin and host agree, and neither is ours.
  EXPECT_EQ(status(server, get("/ws", "evil.example", upgrade("http://evil.example"))), 421);
  EXPECT_EQ(status(server, get("/", "evil.example")), 421);
  EXPECT_EQ(status(server, get("/ws", server.host(), upgrade("http://" + server.host()))), 101);
  EXPECT_EQ(status(server, get("/ws", server.host())), 426);
}

TEST(ViewServer, ElsewhereTheTokenIsNeeded) {
  Server server("127.0.0.1", false);
  const std::string origin = upgrade("http://" + server.host());
  EXPECT_EQ(status(server, get("/ws", server.host(), origin)), 403);
  EXPECT_EQ(status(server, get("/ws?token=0", server.host(), origin)), 403);
  EXPECT_EQ(status(server, get("/", server.host())), 403);
  Page page(server, "/ws?token=" + server.hub().access.token());
  EXPECT_EQ(page.read().at(0), 1U);
}

TEST(ViewServer, WhatIsNoRequestIsAnsweredAndForgotten) {
  Server server;
  for (const std::string& bytes :
       {std::string("\0\xFF\x16\x03\x01", 5), std::string("GET\r\n\r\n"), get("/../../etc/passwd", server.host()),
        get("/" + std::string(100'000, 'a'), server.host()),
        "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999999999\r\n\r\n" + std::string(5000, 'x'),
        std::string("GET / HTTP/1.1\r\n\r\n")}) {
    EXPECT_NE(status(server, bytes), 200) << bytes.substr(0, 40);
  }
  EXPECT_EQ(status(server, get("/nothing", server.host())), 404);
  EXPECT_EQ(status(server, "DELETE / HTTP/1.1\r\nHost: localhost\r\n\r\n"), 405);
  EXPECT_EQ(Page(server).read().at(0), 1U);  // and is there as before
}

TEST(ViewServer, HostileMessagesEndTheirOwnConnectionAlone) {
  Server server;
  server.add(5);
  Page good(server);
  for (const Bytes& message : {Bytes(8, 0xFF), Bytes{1}, Bytes{9, 1, 0, 0, 0, 0, 0, 0}}) {
    Page bad(server);
    bad.send(message);
    EXPECT_EQ(bad.end(), websocket::close_code::policy_error);
  }
  Page text(server);
  text.send_text("{\"hello\":1}");
  EXPECT_EQ(text.end(), websocket::close_code::policy_error);
  Page large(server);
  large.send(Bytes(1 << 20, 1));
  EXPECT_TRUE(large.end() == websocket::close_code::too_big || large.end() == websocket::close_code::none);
  good.send(ask_sweep(0xFFFF'FFFFU));  // of no sweep: the nearest one comes
  EXPECT_EQ(u32(good.until(FrameType::kSweep), 8), 4U);
}

// One that never reads keeps one frame in memory and nobody waiting.
TEST(ViewServer, APageThatNeverReadsHoldsNobodyUp) {
  Server server;
  Page asleep(server);
  Page awake(server);
  std::set<std::uint32_t> seen;
  for (int round = 0; round < 30; ++round) {
    server.add(10, 16000);
    const std::uint32_t last = static_cast<std::uint32_t>(round) * 10 + 9;
    std::uint32_t number = 0;
    do {
      const Bytes frame = awake.until(FrameType::kSweep);
      ASSERT_FALSE(frame.empty());
      number = u32(frame, 8);
      seen.insert(number);
    } while (number != last);
  }
  EXPECT_GE(seen.size(), 30U);
  EXPECT_EQ(server.hub().clients.load(), 2U);
}

TEST(ViewServer, SoManyPagesAndNoMore) {
  Server server;
  std::vector<std::unique_ptr<Page>> pages;
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    pages.push_back(std::make_unique<Page>(server));
    EXPECT_EQ(pages.back()->read().at(0), 1U);
  }
  EXPECT_EQ(status(server, get("/ws", server.host(), upgrade("http://" + server.host()))), 503);
  pages.clear();
  for (int i = 0; i < 500 && server.hub().clients.load() > 0; ++i) std::this_thread::sleep_for(10ms);
  EXPECT_EQ(server.hub().clients.load(), 0U);
  EXPECT_EQ(Page(server).read().at(0), 1U);
}

TEST(ViewServer, RefusesWhatItCannotBind) {
  Server server;
  asio::io_context io;
  EXPECT_THROW(PageServer(io, "127.0.0.1", server.port(), server.hub()), IoError);
  EXPECT_THROW(PageServer(io, "localhost", 0, server.hub()), IoError);
  EXPECT_THROW(PageServer(io, "203.0.113.7", 0, server.hub()), IoError);
  EXPECT_TRUE(is_loopback("127.0.0.9"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
}

}  // namespace
}  // namespace rilo::view
