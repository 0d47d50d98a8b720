// What is wrong with a configuration.
#pragma once

#include <utility>

#include "rilo/io/io_error.hpp"

namespace rilo {

/// An IoError of its own kind, since a wrong configuration is the user's to put right, not the data's.
class ConfigError : public IoError {
 public:
  explicit ConfigError(IoProblem problem) : IoError(std::move(problem)) {}
};

}  // namespace rilo
