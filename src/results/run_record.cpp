#include "results/run_record.hpp"

#include <exception>
#include <utility>

#include "console/interrupt.hpp"

namespace rilo {

void take(SessionResult result, RunRecord& run) {
  static_cast<SessionResult&>(run) = std::move(result);
  if (run.interrupted) run.signal = InterruptGuard::signal();
  if (!run.failure) return;
  try {
    std::rethrow_exception(run.failure);
  } catch (...) {
    const Failure failure = current_failure();
    run.error = failure.message;
    run.error_code = failure.code;
  }
}

}  // namespace rilo
