// What ScanSource::next() gave, kept until it is asked for.
#pragma once

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "rilo/io/io_error.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo::detail {

/// One outcome of next(), with what the source said of it right after.
struct ReadSweep {
  std::optional<Sweep> sweep;
  std::exception_ptr error;  ///< an IoError: it concerns this sweep alone
  std::size_t index = 0;
  std::string name;

  /// Of the data.
  bool is_end() const { return !sweep && !error; }

  /// As next() gives it. @throws the error.
  std::optional<Sweep> take() {
    if (error) std::rethrow_exception(error);
    return std::move(sweep);
  }
};

inline ReadSweep read_sweep(ScanSource& source) {
  ReadSweep read;
  try {
    read.sweep = source.next();
  } catch (const IoError&) {
    read.error = std::current_exception();
  }
  read.index = source.current_index();
  read.name = source.current_name();
  return read;
}

}  // namespace rilo::detail
