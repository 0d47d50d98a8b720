// Exceptions as exit codes.
#pragma once

#include <string>

#include "command.hpp"

namespace rilo::cli {

struct Failure {
  ExitCode code = kSuccess;
  std::string message;
};

/// What the exception that is being handled means. Call it within a catch block.
Failure current_failure();

}  // namespace rilo::cli
