#include "common/tasks.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace crumple {

namespace {

constexpr auto poll_pause = std::chrono::milliseconds(20);

}  // namespace

void share_out(std::size_t count, std::size_t share, int threads,
               const std::function<void(std::size_t, const std::function<bool(double)>&)>& task,
               const std::function<bool(double)>& poll) {
    std::atomic<std::size_t> next{0}, done{0};
    std::atomic<bool> cancelled{false};
    std::exception_ptr thrown;
    std::mutex throwing;
    const std::function<bool(double)> go_on = [&](double) { return !cancelled.load(std::memory_order_relaxed); };
    auto work = [&] {
        for (std::size_t begin = next.fetch_add(share); begin < count; begin = next.fetch_add(share)) {
            for (std::size_t i = begin; i < std::min(begin + share, count); i++) {
                if (!go_on(0)) return;
                try {
                    task(i, go_on);
                } catch (...) {
                    const std::lock_guard<std::mutex> one(throwing);
                    if (!thrown) thrown = std::current_exception();
                    cancelled = true;
                }
                done++;
            }
        }
    };
    std::mutex mutex;
    std::condition_variable ended;
    std::unique_lock<std::mutex> lock(mutex);
    std::size_t working = 0;
    auto member = [&] {
        work();
        const std::lock_guard<std::mutex> own_lock(mutex);
        working--;
        ended.notify_one();
    };
    const std::size_t useful = std::min((count + share - 1) / share, static_cast<std::size_t>(std::max(1, threads)));
    std::vector<std::thread> team;
    team.reserve(useful);
    try {
        while (team.size() < useful) team.emplace_back(member);
    } catch (const std::system_error&) {
        // the system provides no more threads: those that started do the work
        if (team.empty()) throw;
    }
    working = team.size();
    std::exception_ptr failed;
    while (!ended.wait_for(lock, poll_pause, [&] { return working == 0; })) {
        try {
            if (poll && !poll(static_cast<double>(done) / static_cast<double>(count))) cancelled = true;
        } catch (...) {
            failed = std::current_exception();
            cancelled = true;
            break;
        }
    }
    lock.unlock();
    for (std::thread& thread : team) thread.join();
    if (failed) std::rethrow_exception(failed);
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace crumple
