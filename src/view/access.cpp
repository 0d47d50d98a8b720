#include "access.hpp"

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <cerrno>
#include <cstring>
#include <sys/random.h>

#include <fmt/format.h>

#include "io/text.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo::view {

namespace {

// Without port; an IPv6 address without its brackets.
std::string host_name(std::string_view host) {
  if (host.starts_with('[')) return detail::lower_case(host.substr(1, std::min(host.find(']'), host.size()) - 1));
  return detail::lower_case(host.substr(0, host.find(':')));
}

std::string drawn_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw IoError({"getrandom", "", std::strerror(errno), "16 random bytes for the viewer's token", ""});
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

std::string machine_name() {
  boost::system::error_code unknown;
  return detail::lower_case(boost::asio::ip::host_name(unknown));
}

// Time does not tell how much of it was right.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

std::string_view query_value(std::string_view target, std::string_view key) {
  const std::size_t mark = target.find('?');
  std::string_view rest = mark == std::string_view::npos ? std::string_view{} : target.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    if (part.starts_with(key) && part.substr(key.size()).starts_with('=')) return part.substr(key.size() + 1);
  }
  return {};
}

}  // namespace

Access::Access(bool loopback) : token_(loopback ? std::string() : drawn_token()), machine_(machine_name()) {}

bool Access::host_allowed(std::string_view host) const {
  const std::string name = host_name(host);
  boost::system::error_code not_numeric;
  const auto address = boost::asio::ip::make_address(name, not_numeric);
  if (name == "localhost" || (!not_numeric && address.is_loopback())) return true;
  if (token_.empty()) return false;
  return !not_numeric || (!machine_.empty() && (name == machine_ || name.starts_with(machine_ + ".")));
}

bool Access::origin_allowed(std::string_view origin, std::string_view host) {
  return !host.empty() && detail::lower_case(origin) == "http://" + detail::lower_case(host);
}

bool Access::token_allowed(std::string_view target) const {
  return token_.empty() || same(query_value(target, "token"), token_);
}

}  // namespace rilo::view
