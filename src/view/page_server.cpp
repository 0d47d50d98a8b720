#include "page_server.hpp"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/strand.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <utility>

#include <fmt/format.h>

#include "page_files.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::view {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

namespace {

constexpr std::size_t kHeaderLimit = 8192;
constexpr auto kPatience = std::chrono::seconds(10);

asio::ip::address numeric(const std::string& address) {
  boost::system::error_code error;
  auto parsed = asio::ip::make_address(address, error);
  if (error) {
    throw IoError(
        {"address of the viewer", "", "'" + address + "'", "a numeric address such as 127.0.0.1, 0.0.0.0 or ::1", ""});
  }
  return parsed;
}

using Response = http::response<http::string_body>;

// Nothing from elsewhere runs in the page, and the page is shown in no other.
void add_policy(Response& response) {
  response.set("Content-Security-Policy",
               "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
               "base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set(http::field::cache_control, "no-store");
}

/// One HTTP connection, until it ends or becomes a WebSocket.
class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(tcp::socket socket, Hub& hub) : stream_(std::move(socket)), hub_(hub) { ++hub_.connections; }
  ~HttpConnection() { --hub_.connections; }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(kHeaderLimit);
    parser_->body_limit(0);
    stream_.expires_after(kPatience);
    http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (!error) self->answer();
    });
  }

 private:
  void answer() {
    const auto& request = parser_->get();
    const std::string target(request.target());
    const std::string path = target.substr(0, target.find('?'));
    const std::string_view host = field(http::field::host);
    if (!hub_.access.host_allowed(host)) {
      return say(http::status::misdirected_request, "This host name is not one of the viewer's.");
    }
    if (path == "/ws") return upgrade(target, host);
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return say(http::status::method_not_allowed, "Only GET.");
    }
    if (path == "/" && !hub_.access.token_allowed(target)) {
      return say(http::status::forbidden, "The token is missing: open the whole address that rilo printed.");
    }
    const auto files = page_files();
    const auto file = std::find_if(files.begin(), files.end(), [&](const PageFile& f) { return f.path == path; });
    if (file == files.end()) return say(http::status::not_found, "Nothing here.");
    Response response(http::status::ok, request.version());
    response.set(http::field::content_type, beast::string_view(file->type.data(), file->type.size()));
    response.set(http::field::content_encoding, "gzip");
    response.body() = std::string(file->gzip);
    send(std::move(response));
  }

  void upgrade(const std::string& target, std::string_view host) {
    if (!beast::websocket::is_upgrade(parser_->get())) return say(http::status::upgrade_required, "A WebSocket.");
    if (!Access::origin_allowed(field(http::field::origin), host)) {
      return say(http::status::forbidden, "Only the viewer's own page may connect.");
    }
    if (!hub_.access.token_allowed(target)) return say(http::status::forbidden, "The token is wrong.");
    if (hub_.clients >= kMaxClients) return say(http::status::service_unavailable, "Too many viewers.");
    auto socket = std::make_shared<PageSocket>(std::move(stream_), hub_);
    hub_.add(socket);
    socket->start(PageSocket::Request(parser_->get()));
  }

  std::string_view field(http::field name) const {
    const beast::string_view value = parser_->get()[name];
    return {value.data(), value.size()};
  }

  void say(http::status status, const std::string& text) {
    Response response(status, parser_->get().version());
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    response.body() = "rilo viewer: " + text + "\n";
    send(std::move(response));
  }

  void send(Response response) {
    add_policy(response);
    response.keep_alive(parser_->get().keep_alive() && response.result() == http::status::ok);
    response.prepare_payload();
    if (parser_->get().method() == http::verb::head) response.body().clear();
    response_ = std::move(response);
    http::async_write(stream_, response_, [self = shared_from_this()](beast::error_code error, std::size_t) {
      if (error) return;
      if (self->response_.keep_alive()) return self->read();
      boost::system::error_code ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  beast::tcp_stream stream_;
  Hub& hub_;
  beast::flat_buffer buffer_{2 * kHeaderLimit};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Response response_;
};

}  // namespace

bool is_loopback(const std::string& address) { return numeric(address).is_loopback(); }

PageServer::PageServer(asio::io_context& io, const std::string& address, std::optional<std::uint16_t> port, Hub& hub)
    : hub_(hub), acceptor_(io), pause_(io) {
  const tcp::endpoint wanted(numeric(address), port.value_or(kViewPort));
  boost::system::error_code error;
  acceptor_.open(wanted.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(wanted, error);
  if (error == asio::error::address_in_use && !port) {
    error = {};
    acceptor_.bind(tcp::endpoint(wanted.address(), 0), error);
  }
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    throw IoError({fmt::format("viewer at {}, port {}", address, wanted.port()), "", error.message(),
                   "an address of this machine and a free port", "Port 0 takes any free one"});
  }
}

void PageServer::accept() {
  acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted || !acceptor_.is_open()) return;
    if (error) return pause();
    // Beyond, it is closed at once: the run needs file descriptors, too.
    if (hub_.connections < kMaxConnections) std::make_shared<HttpConnection>(std::move(socket), hub_)->read();
    accept();
  });
}

// The connection stays in the queue when there are no file descriptors or no memory: at once it would fail again.
void PageServer::pause() {
  ++pauses_;
  pause_.expires_after(kAcceptPause);
  pause_.async_wait([this](beast::error_code error) {
    if (!error && acceptor_.is_open()) accept();
  });
}

void PageServer::stop() {
  boost::system::error_code ignored;
  acceptor_.close(ignored);
  pause_.cancel();
  for (const auto& socket : hub_.sockets) {
    if (const auto alive = socket.lock()) alive->close();
  }
}

}  // namespace rilo::view
