// Messages that arrive now, in the shape of a recording.
#pragma once

#include <memory>

#include "io/ros/recording.hpp"
#include "rilo/io/live_queue.hpp"

namespace rilo::detail {

/// The first selection gives the messages of the looking ahead and keeps them, the next one gives them again and goes
/// on.
std::unique_ptr<Recording> open_live(std::shared_ptr<LiveQueue> queue);

}  // namespace rilo::detail
