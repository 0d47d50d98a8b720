#include "console/failure.hpp"

#include <exception>
#include <new>
#include <stdexcept>
#include <system_error>

#include "rilo/config/config_file.hpp"
#include "rilo/io/io_error.hpp"

namespace rilo {

ExitCode exit_code(RunErrorKind kind) {
  switch (kind) {
    case RunErrorKind::kUsage:
      return kUsage;
    case RunErrorKind::kBadData:
      return kBadData;
    case RunErrorKind::kCannotWrite:
      return kCannotWrite;
    case RunErrorKind::kUnexpected:
      break;
  }
  return kUnexpected;
}

RunErrorKind kind_of(ExitCode code) {
  for (const RunErrorKind kind : {RunErrorKind::kUsage, RunErrorKind::kBadData, RunErrorKind::kCannotWrite}) {
    if (exit_code(kind) == code) return kind;
  }
  return RunErrorKind::kUnexpected;
}

Failure current_failure() {
  try {
    throw;
  } catch (const RunError& error) {
    return {exit_code(error.kind()), error.what()};
  } catch (const ConfigError& error) {
    return {kUsage, error.what()};
  } catch (const IoError& error) {
    return {kBadData, error.what()};
  } catch (const std::invalid_argument& error) {
    return {kUsage, error.what()};
  } catch (const std::bad_alloc&) {
    return {kUnexpected, "out of memory"};
  } catch (const std::system_error& error) {
    // Of threads and processes that could not be started: "Resource temporarily unavailable" alone is not helpful.
    const bool exhausted = error.code() == std::errc::resource_unavailable_try_again;
    return {kUnexpected, error.what() + std::string(exhausted ? ": out of memory, or of threads and processes" : "")};
  } catch (const std::exception& error) {
    return {kUnexpected, error.what()};
  }
}

}  // namespace rilo
