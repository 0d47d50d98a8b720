// Errors of a run and of its results, by their cause.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace rilo {

enum class RunErrorKind : std::uint8_t {
  kUsage,        ///< the request makes no sense: options, configuration
  kBadData,      ///< data missing, malformed or not fit for the request
  kCannotWrite,  ///< a result could not be written
  kUnexpected,   ///< a bug or an exhausted machine
};

class RunError : public std::runtime_error {
 public:
  RunError(RunErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  RunErrorKind kind() const { return kind_; }

 private:
  RunErrorKind kind_;
};

}  // namespace rilo
