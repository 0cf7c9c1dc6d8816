#include "common/team.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>

namespace crumple::shell {

namespace {

// Time for which a member spins before it sleeps: longer than the work between two calls of a run.
constexpr auto awake = std::chrono::microseconds(200);

}  // namespace

// The members except the caller.
struct Team::Crew {
    explicit Crew(int others) : asked(others) {
        threads.reserve(std::size_t(others));
        try {
            for (int i = 1; i <= others; i++) threads.emplace_back([this, i] { serve(i); });
        } catch (const std::system_error&) {
            // the system provides no more threads: those that started do the work
        }
    }
    ~Crew() {
        assign(nullptr);
        for (std::thread& thread : threads) thread.join();
    }
    // Starts the next task; null ends the threads.
    void assign(const std::function<void(int)>* next) {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            task = next;
            busy.store(int(threads.size()), std::memory_order_relaxed);
            calls.fetch_add(1, std::memory_order_release);
        }
        called.notify_all();
    }
    void serve(int index) {
        for (unsigned seen = 0;; seen++) {
            await_call(seen);
            if (!task) return;
            (*task)(index);
            busy.fetch_sub(1, std::memory_order_release);
        }
    }
    void await_call(unsigned seen) {
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; calls.load(std::memory_order_acquire) == seen; i++) {
            if (i < spins_before_yield) {
                spin();
                continue;
            }
            std::this_thread::yield();
            if (std::chrono::steady_clock::now() - start < awake) continue;
            std::unique_lock<std::mutex> lock(mutex);
            called.wait(lock, [&] { return calls.load(std::memory_order_relaxed) != seen; });
        }
    }
    void await_end() const {
        for (int i = 0; busy.load(std::memory_order_acquire) != 0; i++) {
            if (i < spins_before_yield)
                spin();
            else
                std::this_thread::yield();
        }
    }

    const int asked;                             // requested number of threads
    std::mutex mutex;
    std::condition_variable called;
    alignas(64) std::atomic<unsigned> calls{0};
    alignas(64) std::atomic<int> busy{0};
    const std::function<void(int)>* task = nullptr;
    std::vector<std::thread> threads;            // declared last: they use the members above
};

Team::Team() = default;

Team::~Team() { dismiss(); }

void Team::dismiss() {
    if (process_ != process_number()) crew_.release();
    crew_.reset();
}

int Team::gather(int members) {
    if (members == 1) return members_ = 1;
    if (!crew_ || process_ != process_number() || crew_->asked != members - 1) {
        dismiss();
        process_ = process_number();
        crew_ = std::make_unique<Crew>(members - 1);
    }
    return members_ = int(crew_->threads.size()) + 1;
}

void Team::call(const std::function<void(int)>& task) {
    if (members_ == 1) return task(0);
    crew_->assign(&task);
    task(0);
    crew_->await_end();
}

}  // namespace crumple::shell
