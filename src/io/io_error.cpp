#include "rilo/io/io_error.hpp"

#include <utility>

namespace rilo {
namespace {

std::string message_of(const IoProblem& problem) {
  std::string text = problem.file.string();
  if (!problem.position.empty()) text += (text.empty() ? "" : ", ") + problem.position;
  if (!text.empty()) text += ": ";
  text += problem.found;
  if (!problem.expected.empty()) text += "; expected " + problem.expected;
  text += ".";
  if (!problem.remedy.empty()) text += " " + problem.remedy + ".";
  return text;
}

}  // namespace

IoError::IoError(IoProblem problem) : std::runtime_error(message_of(problem)), problem_(std::move(problem)) {}

}  // namespace rilo
