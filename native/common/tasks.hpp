// Parallel execution of many independent tasks.
#pragma once

#include <cstddef>
#include <functional>

namespace crumple {

// Calls `task(i, go_on)` for every i < `count`.  A thread takes `share` tasks at a time; at most `threads` threads work, fewer
// if the system does not provide them (std::system_error if it provides none).  `go_on` returns false once the work is
// cancelled; tasks that have not begun by then are skipped.  `poll` is called regularly on the calling thread with the
// completed share and returns false to cancel.  An exception of `poll` or of a task is rethrown after all threads have ended.
void share_out(std::size_t count, std::size_t share, int threads,
               const std::function<void(std::size_t, const std::function<bool(double)>&)>& task,
               const std::function<bool(double)>& poll);

}  // namespace crumple
