// The server as a browser meets it, and as somebody who means harm does.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "browser_side.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::view {
namespace {

using namespace std::chrono_literals;

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

// It looks back before the first points are there.
TEST(ViewServer, ASweepThatIsAskedForTooEarlyComesLater) {
  Server server;
  Page page(server);
  page.send({2, 1, 0, 0, 0, 0, 0, 0});  // follow nothing
  page.send(ask_sweep(0));
  EXPECT_EQ(page.read().at(0), 1U);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // it is read meanwhile: nothing tells
  server.add(1);
  const Bytes frame = page.until(FrameType::kSweep);
  ASSERT_FALSE(frame.empty());
  EXPECT_EQ(u32(frame, 8), 0U);
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

TEST(ViewServer, ConnectionsThatSayNothingLeaveDescriptorsToTheRun) {
  const Server server;
  asio::io_context io;
  std::vector<tcp::socket> silent;
  for (std::size_t i = 0; i < kMaxConnections; ++i) silent.push_back(connect(io, server));
  EXPECT_EQ(status(server, get("/nothing", server.host())), 0);
  silent.clear();
  int answered = 0;
  for (int i = 0; i < 500 && answered == 0; ++i) {
    answered = status(server, get("/nothing", server.host()));
    std::this_thread::sleep_for(10ms);
  }
  EXPECT_EQ(answered, 404);
}

TEST(ViewServer, PagesThatAreGoneAreForgotten) {
  Server server;
  for (int i = 0; i < 30; ++i) {
    EXPECT_EQ(Page(server).read().at(0), 1U);
    while (server.hub().clients.load() > 0) std::this_thread::sleep_for(1ms);
  }
  EXPECT_LE(server.known_pages(), 1U);
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
