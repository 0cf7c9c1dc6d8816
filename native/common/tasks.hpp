// Many independent tasks on several threads.
#pragma once

#include <cstddef>
#include <functional>

namespace crumple {

// Calls `task(i, go_on)` for every i below `count`, `share` of them at a time to a thread, on `threads` at most and as many
// as the machine gives; it throws std::system_error where that is none.  `go_on` turns false once the work is cancelled,
// and tasks not begun by then are left out.  `poll` gets the share done, now and then, on the calling thread, and returns
// false to cancel; what it or a task throws comes through when all threads
// have ended.
void share_out(std::size_t count, std::size_t share, int threads,
               const std::function<void(std::size_t, const std::function<bool(double)>&)>& task,
               const std::function<bool(double)>& poll);

}  // namespace crumple
