// Who may look.
#pragma once

#include <string>
#include <string_view>

namespace rilo::view {

/// Decides by what a browser says of itself. A page of another site can make a browser connect here: what tells it from
/// ours is the origin. It can have its own name point here (DNS rebinding): what tells that is the host it asks for.
class Access {
 public:
  /// `loopback`: bound to this machine alone; otherwise a token is drawn.
  /// @throws IoError when the system has no random numbers.
  explicit Access(bool loopback);

  /// Whether a request for `host` (the header, with or without a port) can be meant for us: a loopback name on a
  /// loopback address, else also a numeric address or the machine's own name.
  bool host_allowed(std::string_view host) const;

  /// Whether a connection from a page of `origin` is one from the page that was served under `host`. No origin is not
  /// allowed.
  static bool origin_allowed(std::string_view origin, std::string_view host);

  /// Whether the target of a request (/path?token=…) has the token, or none is needed.
  bool token_allowed(std::string_view target) const;

  /// Empty: none is needed.
  const std::string& token() const { return token_; }

 private:
  std::string token_;
  std::string machine_;
};

}  // namespace rilo::view
