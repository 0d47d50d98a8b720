// The one exception of everything that reads or writes files.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace rilo {

/// What went wrong, in the parts a reader of the message needs. Parts without meaning for a problem stay empty.
struct IoProblem {
  std::filesystem::path file;
  std::string position;  ///< "line 12, column 3" or "byte 4711"
  std::string found;
  std::string expected;
  std::string remedy;  ///< what to do, a sentence without the full stop
};

/// Message: "FILE, POSITION: what was found; expected …. What to do."
class IoError : public std::runtime_error {
 public:
  explicit IoError(IoProblem problem);

  const IoProblem& problem() const { return problem_; }

 private:
  IoProblem problem_;
};

}  // namespace rilo
