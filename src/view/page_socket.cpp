#include "page_socket.hpp"

#include <chrono>
#include <span>
#include <utility>

namespace rilo::view {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

namespace {

constexpr int kSendBufferBytes = 1 << 19;  // what waits in the system is old when it arrives

}  // namespace

void Hub::add(const std::shared_ptr<PageSocket>& socket) {
  std::erase_if(sockets, [](const auto& known) { return known.expired(); });
  sockets.push_back(socket);
}

void Hub::wake() {
  for (const auto& socket : sockets) {
    if (const auto alive = socket.lock()) alive->pump();
  }
}

void Hub::start_over() {
  history = ViewHistory(info, options);
  for (const auto& socket : sockets) {
    if (const auto alive = socket.lock()) alive->close();
  }
}

PageSocket::PageSocket(beast::tcp_stream stream, Hub& hub) : socket_(std::move(stream)), hub_(hub) { ++hub_.clients; }

PageSocket::~PageSocket() { --hub_.clients; }

void PageSocket::start(const Request& request) {
  beast::get_lowest_layer(socket_).expires_never();
  auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
  timeout.idle_timeout = std::chrono::seconds(30);
  timeout.keep_alive_pings = true;
  socket_.set_option(timeout);
  socket_.read_message_max(64);
  socket_.auto_fragment(false);
  socket_.binary(true);
  boost::system::error_code ignored;
  beast::get_lowest_layer(socket_).socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBufferBytes),
                                                       ignored);
  socket_.async_accept(request, [self = shared_from_this()](beast::error_code error) {
    if (error) return;
    self->open_ = true;
    self->read();
    self->pump();
  });
}

void PageSocket::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](beast::error_code error, std::size_t bytes) {
    self->on_read(error, bytes);
  });
}

void PageSocket::on_read(beast::error_code error, std::size_t bytes) {
  if (error) {
    open_ = false;  // closed, too long, or no WebSocket at all: Beast has answered as it should
    return;
  }
  const std::span<const std::uint8_t> message(static_cast<const std::uint8_t*>(incoming_.data().data()), bytes);
  const auto request = socket_.got_binary() ? parse_request(message) : std::nullopt;
  incoming_.consume(bytes);
  if (!request) {
    refuse(websocket::close_code::policy_error, "not a request of protocol version 1");
    return;
  }
  if (request->kind == rilo::view::Request::Kind::kFollow) {
    follow_ = request->value == 1;
  } else {
    wanted_ = request->value;
  }
  pump();
  read();
}

void PageSocket::refuse(websocket::close_code code, const std::string& why) {
  open_ = false;
  socket_.async_close({code, why}, [self = shared_from_this()](beast::error_code) {});
}

void PageSocket::close() {
  open_ = false;
  boost::system::error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

void PageSocket::pump() {
  if (!open_ || outgoing_) return;
  outgoing_ = next_frame();
  if (!outgoing_) return;
  socket_.async_write(boost::asio::buffer(*outgoing_),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        self->outgoing_ = nullptr;
                        if (error) self->open_ = false;
                        self->pump();
                      });
}

Frame PageSocket::next_frame() {
  const ViewHistory& history = hub_.history;
  if (!told_info_) {
    told_info_ = true;
    return history.info();
  }
  if (told_records_ < history.records()) {
    Frame frame = history.records_from(told_records_);
    told_records_ += static_cast<std::uint32_t>((frame->size() - 2 * kHeaderBytes) / kRecordBytes);
    return frame;
  }
  if (told_progress_ != history.progress()) {
    told_progress_ = history.progress();
    return progress_frame(told_progress_);
  }
  map_turn_ = !map_turn_;
  Frame first = map_turn_ ? next_map() : next_sweep();
  return first ? first : (map_turn_ ? next_sweep() : next_map());
}

Frame PageSocket::next_sweep() {
  const SweepStore& sweeps = hub_.history.sweeps();
  if (wanted_) {
    // None yet: it stays wanted.
    if (Frame frame = sweeps.at(*wanted_)) {
      wanted_.reset();
      return frame;
    }
  }
  if (!follow_ || sweeps.size() == 0 || told_sweep_ == sweeps.newest_number()) return nullptr;
  told_sweep_ = sweeps.newest_number();
  return sweeps.newest();
}

Frame PageSocket::next_map() {
  const ViewHistory& history = hub_.history;
  if (told_epoch_ != history.map_epoch()) {
    told_epoch_ = history.map_epoch();
    told_map_frames_ = 0;
  }
  if (told_map_frames_ >= history.map_frames().size()) return nullptr;
  return history.map_frames()[told_map_frames_++];
}

}  // namespace rilo::view
