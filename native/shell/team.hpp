// A team of threads that runs stages one after another, with a barrier that spins first and yields then.
#pragma once
#include <atomic>
#include <thread>
#include <vector>

namespace crumple::shell {

// Blocking system barriers cost more than a stage on a busy machine; spinning alone would starve the others.
constexpr int spins_before_yield = 2000;

class Barrier {
public:
    explicit Barrier(int members) : members_(members) {}
    // The last member to arrive runs `serial` before all go on.
    template <class Serial> void wait(Serial serial) {
        const unsigned phase = phase_.load(std::memory_order_relaxed);
        if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == members_) {
            serial();
            arrived_.store(0, std::memory_order_relaxed);
            phase_.store(phase + 1, std::memory_order_release);
            return;
        }
        for (int i = 0; phase_.load(std::memory_order_acquire) == phase; i++) {
            if (i < spins_before_yield)
                pause();
            else
                std::this_thread::yield();
        }
    }

private:
    static void pause() {
#if defined(__x86_64__) || defined(_M_X64)
        __builtin_ia32_pause();
#endif
    }
    const int members_;
    alignas(64) std::atomic<int> arrived_{0};
    alignas(64) std::atomic<unsigned> phase_{0};
};

struct Range {
    std::size_t first, last;
};
// Share of one member of [0, n), in whole chunks: shares follow one another.
inline Range share_of(std::size_t n, int member, int members, std::size_t chunk = 1) {
    const std::size_t chunks = (n + chunk - 1) / chunk, m = std::size_t(member), all = std::size_t(members);
    const std::size_t first = chunks * m / all * chunk, last = chunks * (m + 1) / all * chunk;
    return {first < n ? first : n, last < n ? last : n};
}

// One member's part in the work of its team; made by default, the only one.
struct Member {
    int index = 0, count = 1;
    Barrier* barrier = nullptr;

    Range share(std::size_t n, std::size_t chunk = 1) const { return share_of(n, index, count, chunk); }
    // Waits for the others; the last to arrive runs `serial` before all go on.
    template <class Serial> void meet(Serial serial) const {
        if (barrier)
            barrier->wait(serial);
        else
            serial();
    }
};

// Runs work(member) on so many members; the caller is the first.
template <class Work> void run_team(int members, Work work) {
    Barrier barrier(members);
    std::vector<std::thread> others;
    for (int i = 1; i < members; i++) others.emplace_back([&, i] { work(Member{i, members, &barrier}); });
    work(Member{0, members, &barrier});
    for (std::thread& t : others) t.join();
}

}  // namespace crumple::shell
