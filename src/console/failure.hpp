// Exit codes, and what an exception means as one.
#pragma once

#include <string>

#include "rilo/session/session.hpp"

namespace rilo {

/// Exit codes; `rilo --help` and docs/command.md list them.
enum ExitCode : int {
  kSuccess = 0,
  kUnexpected = 1,    ///< a bug or an exhausted machine
  kUsage = 2,         ///< command line or configuration
  kBadData = 3,       ///< data missing, malformed or of no known format
  kCannotWrite = 4,   ///< results could not be written
  kSignalBase = 128,  ///< + the signal's number: 129 SIGHUP, 130 SIGINT, 143 SIGTERM; what was done is written
};

struct Failure {
  ExitCode code = kSuccess;
  std::string message;
};

ExitCode exit_code(RunErrorKind kind);
/// The other way round; kUnexpected for every other code.
RunErrorKind kind_of(ExitCode code);

/// What the exception that is being handled means. Call it within a catch block.
Failure current_failure();

}  // namespace rilo
