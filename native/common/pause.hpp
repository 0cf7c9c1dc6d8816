// Cancellation of long computations: they call `pause` often, which occasionally asks the caller whether to continue and throws
// `Stopped` if not.
#pragma once
#include <chrono>
#include <functional>

namespace crumple {

struct Stopped {};

// The function that this thread calls to check for cancellation.
class Asking {
public:
    explicit Asking(const std::function<bool()>& go_on) : go_on_(go_on), before_(present()), next_(Clock::now() + pause_between) { present() = this; }
    ~Asking() { present() = before_; }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

    static void pause() {
        Asking* asked = present();
        // read the clock in one of 16 calls only
        if (asked && ++asked->calls_ % calls_per_look == 0) asked->look();
    }

private:
    using Clock = std::chrono::steady_clock;
    // short enough for an immediate response, long compared with the cost of one check
    static constexpr std::chrono::milliseconds pause_between{50};
    static constexpr int calls_per_look = 16;

    static Asking*& present() {
        thread_local Asking* one = nullptr;
        return one;
    }
    void look() {
        if (Clock::now() < next_) return;
        next_ = Clock::now() + pause_between;
        if (!go_on_()) throw Stopped();
    }

    const std::function<bool()> go_on_;
    Asking* const before_;
    Clock::time_point next_;
    unsigned calls_ = 0;
};

inline void pause() { Asking::pause(); }

}  // namespace crumple
