// A persistent team of threads that executes stages in sequence, with a barrier that first spins and then yields.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "common/machine.hpp"

namespace crumple::shell {

// A blocking system barrier takes longer than a stage; pure spinning would starve other threads on a busy machine.
constexpr int spins_before_yield = 2000;

class Barrier {
public:
    explicit Barrier(int members) : members_(members) {}
    // The last member to arrive runs `serial` before all continue.
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
                spin();
            else
                std::this_thread::yield();
        }
    }

private:
    const int members_;
    alignas(64) std::atomic<int> arrived_{0};
    alignas(64) std::atomic<unsigned> phase_{0};
};

struct Range {
    std::size_t first, last;
};
// Contiguous share of one member in [0, n), in whole chunks.
inline Range share_of(std::size_t n, int member, int members, std::size_t chunk = 1) {
    const std::size_t chunks = (n + chunk - 1) / chunk, m = std::size_t(member), all = std::size_t(members);
    const std::size_t first = chunks * m / all * chunk, last = chunks * (m + 1) / all * chunk;
    return {first < n ? first : n, last < n ? last : n};
}

// One member of a team and its barrier; a default-constructed member works alone.
struct Member {
    int index = 0, count = 1;
    Barrier* barrier = nullptr;

    Range share(std::size_t n, std::size_t chunk = 1) const { return share_of(n, index, count, chunk); }
    // Waits for the other members; the last to arrive runs `serial` before all continue.
    template <class Serial> void meet(Serial serial) const {
        if (barrier)
            barrier->wait(serial);
        else
            serial();
    }
};

// Work stealing: pieces of work are assigned to the members in advance, so that each member finds its data of the last call in its
// caches; a member that has finished takes pieces from the end of another member's share.
class Shares {
public:
    explicit Shares(int members) : rest_(std::size_t(members)) {}
    // Assigns the pieces; called by one member before any member calls `take`.
    void deal(std::size_t pieces) {
        const int members = int(rest_.size());
        for (int i = 0; i < members; i++) {
            const Range own = share_of(pieces, i, members);
            rest_[std::size_t(i)].range.store(packed(own.first, own.last), std::memory_order_relaxed);
        }
    }
    // Calls work(piece) until no piece is left.
    template <class Work> void take(const Member& member, Work work) {
        for (std::size_t k = 0; k < rest_.size(); k++) {
            std::atomic<std::uint64_t>& range = rest_[(std::size_t(member.index) + k) % rest_.size()].range;
            for (std::size_t piece; pop(range, k == 0, piece);) work(piece);
        }
    }

private:
    struct alignas(64) Rest {
        std::atomic<std::uint64_t> range{0};     // first and last piece that are left
    };
    static std::uint64_t packed(std::size_t first, std::size_t last) { return std::uint64_t(first) << 32 | std::uint64_t(last); }
    static bool pop(std::atomic<std::uint64_t>& range, bool front, std::size_t& piece) {
        for (std::uint64_t now = range.load(std::memory_order_relaxed);;) {
            const std::size_t first = std::size_t(now >> 32), last = std::size_t(now & 0xffffffffu);
            if (first == last) return false;
            piece = front ? first : last - 1;
            const std::uint64_t then = front ? packed(first + 1, last) : packed(first, last - 1);
            if (range.compare_exchange_weak(now, then, std::memory_order_relaxed)) return true;
        }
    }
    std::vector<Rest> rest_;                     // [member]
};

// Threads that persist between calls: a run that returns to Python every few steps calls every few hundred microseconds, about the
// time that starting a thread takes.  Between calls they spin for a while, then they sleep.
class Team {
public:
    Team();
    ~Team();
    // Sets the number of members, the caller being the first; returns how many there are: fewer if the system has no more threads.
    int gather(int members);
    // Runs work(member) on all members.
    template <class Work> void run(Work work) {
        Barrier barrier(members_);
        call([&](int index) { work(Member{index, members_, &barrier}); });
    }

private:
    struct Crew;
    void call(const std::function<void(int)>& task);
    void dismiss();

    std::unique_ptr<Crew> crew_;
    int members_ = 1;
    long long process_ = 0;          // process that started the crew; a forked process has no crew and must not wait for it
};

}  // namespace crumple::shell
