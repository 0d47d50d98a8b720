// PointCloud2 messages as they arrive, read by the code that reads them from recordings.
#pragma once

#include <memory>

#include "rilo/io/live_queue.hpp"
#include "rilo/io/scan_source.hpp"

namespace rilo {

/// A source whose next() waits for the next message, and ends when the queue is closed. Opening it waits for the
/// messages of the looking ahead. The sweeps are those that a recording of the same messages gives, to the last bit.
/// Options that concern files are ignored; nothing is read ahead.
std::unique_ptr<ScanSource> open_live_source(std::shared_ptr<LiveQueue> queue, const SourceOptions& options = {});

}  // namespace rilo
