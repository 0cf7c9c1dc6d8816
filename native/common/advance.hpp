// Detection of runs that no longer advance: a run ends if many steps or linear solves advance its time by almost nothing, and
// reports the most frequent outcome of these steps.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

namespace crumple {

// A run ends at an inaccurate step of the smallest length that changes the energy balance by more than this share of the
// energy: twice the share for which a whole result is refused.
inline constexpr double refused_share = 2e-3;
// Message of such a run, and its usual cause if motion is prescribed.
inline constexpr const char* lost_balance = "a step of the smallest length was not accurate and lost the balance of energy";
inline constexpr const char* driven_without_solution = "; where what is driven meets what cannot give way they have no solution";

// Outcome of an attempted step.
enum class Attempted { taken, inexact, unsolved, closing, impact };

class Advance {
public:
    void begin(double t, double duration, std::int64_t solves) {
        duration_ = duration;
        mark_steps(t);
        mark_solves(t, solves);
    }

    void count(Attempted what) { counts_[static_cast<size_t>(what)]++; }

    // Reason for which the run ends at this time, after so many linear solves; empty if it continues.
    std::string stalled(double t, std::int64_t solves) {
        if (t >= next_by_steps_) mark_steps(t);
        if (t >= next_by_solves_) mark_solves(t, solves);
        if (attempts() >= most_attempts) return "10000 steps in a row advanced the run by less than 0.1 % of its time; " + cause();
        if (solves - solves_ > most_solves) return "100000 linear solves advanced the run by less than 1 % of its time; " + cause();
        return {};
    }

private:
    // Limits of the steps and of the linear solves that may pass before the run advances by a share of its time; a whole run
    // may then take at most ten million of either.
    static constexpr int most_attempts = 10'000, most_solves = 100'000;
    static constexpr double share_by_steps = 1e-3, share_by_solves = 1e-2;

    void mark_steps(double t) {
        next_by_steps_ = t + share_by_steps * duration_;
        counts_.fill(0);
    }

    void mark_solves(double t, std::int64_t solves) {
        next_by_solves_ = t + share_by_solves * duration_;
        solves_ = solves;
    }

    int attempts() const {
        int sum = 0;
        for (const int n : counts_) sum += n;
        return sum;
    }

    std::string cause() const {
        static constexpr std::array<const char*, 5> texts{
            "most of these steps were accurate, but very short", "most of these steps were not accurate and were shortened",
            "the equations of most of these steps did not converge", "most of these steps were shortened to end where a contact closes",
            "most of these steps were impacts: something presses on what cannot give way"};
        return texts[static_cast<size_t>(std::max_element(counts_.begin(), counts_.end()) - counts_.begin())];
    }

    double duration_ = 0, next_by_steps_ = 0, next_by_solves_ = 0;
    std::int64_t solves_ = 0;
    std::array<int, 5> counts_{};  // number of each `Attempted` since the run last advanced
};

}  // namespace crumple
