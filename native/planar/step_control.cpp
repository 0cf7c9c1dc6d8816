// Step control: error estimate from one step and two half steps, shorter steps if the error is too large, step ends at breaks.
#include <algorithm>
#include <cmath>

#include "planar/simulation.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Error allowed in one step, measured by the difference between one step and two half steps.  The local error is proportional to
// h^3 and the error of the whole motion to h^2, so below `loosest_share` the error allowed in a step is reduced by a further factor,
// the square root of accuracy/loosest_share: the error of the motion is then proportional to the accuracy, and a quarter of the
// accuracy halves the step.  If each step were allowed the full accuracy, the verification problems would exceed it from 1e-5 on.
constexpr double loosest_share = 1e-3;

// Energy by which a step may be off its balance if vibration is passed over, which the error measure then does not see.
constexpr double vibrating_share = 2e-4;

constexpr double safety = 0.9, shrink_limit = 0.2, growth_limit = 4;

// length and error of an attempted step
struct Attempt {
    double h = 0, e = 0;
};

// Order of the error in the step length: three, but down to one where velocities jump; estimated from two step lengths from the
// same state.
double error_order(const Attempt& rejected, const Attempt& present) {
    if (rejected.h == 0 || !(present.e > 1)) return 3;
    return std::clamp(std::log(rejected.e / present.e) / std::log(rejected.h / present.h), 1.0, 3.0);
}

constexpr std::int64_t poll_interval = 100'000;  // solves times bodies between calls of `poll`: some 10 ms

}  // namespace

double step_tolerance(double accuracy) { return accuracy * std::min(1.0, std::sqrt(accuracy / loosest_share)); }

double kinetic_norm(const Tree& tree, const std::vector<Twist>& a, const std::vector<Twist>* b) {
    double e = 0;
    for (int i = 0; i < tree.bodies(); i++) {
        const auto k = static_cast<size_t>(i);
        Twist v = a[k];
        if (b) v = {v.w - (*b)[k].w, v.v - (*b)[k].v};
        e += value(tree[i].mass * dot(v.v, v.v) + tree[i].inertia * v.w * v.w);
    }
    return std::sqrt(e);
}

// Largest difference of joint coordinates between a step and its halves, and that of velocities as `speed`, without vibration that
// need not be resolved.
double Simulation::moved_apart(const State& coarse, const State& fine, double& speed) {
    for (size_t k = 0; k < turned_.size(); k++) {
        turned_[k] = fine.q[k] - coarse.q[k];
        sped_[k] = fine.w[k] - coarse.w[k];
    }
    if (stepper_.filters()) {
        stepper_.filter(fine, sped_.data(), turned_.data());
        speed = stepper_.speed_of(fine, sped_.data());
    } else {
        speed = kinetic_norm(model_.tree, coarse.velocity, &fine.velocity);
    }
    double worst = 0;
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Body& b = model_.tree[i];
        const int n = b.joint == Joint::revolute ? 1 : 3;
        for (int k = 0; k < n; k++) {
            const double e = std::fabs(value(turned_[static_cast<size_t>(b.dof + k)]));
            worst = std::max(worst, k == 0 ? e : e / value(model_.length));
        }
    }
    return worst;
}

// Energy imbalance of a step relative to the energy supplied to the structure, or what a hinge gives back of its dissipated energy: the
// mean of opposite moments at both ends of a step, times the flow in the sense of the later one, is negative.
double Simulation::unbalance(const State& fine) const {
    const Energies after = energies(model_, fine), before = energies(model_, state_);
    double wrong = std::fabs(value(after.balance() - before.balance()));
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        wrong = std::max(wrong, value(state_.hinge[j].dissipated - fine.hinge[j].dissipated));
    }
    const double reference = std::max(start_energy_ + std::max(work_max_, std::fabs(value(after.external_work))), negligible_energy_);
    return reference > 0 ? wrong / reference : 0;
}

double Simulation::error(const State& coarse, const State& fine) {
    double apart = 0, worst = moved_apart(coarse, fine, apart);
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        worst = std::max(worst, value(fine.hinge[j].overrun - state_.hinge[j].overrun));
    }
    double e = worst / scale_;
    const double speed = std::max(speed_, negligible_speed_);
    if (speed > 0) e = std::max(e, apart / speed);
    e /= step_tolerance_;
    return stepper_.filters() ? std::max(e, unbalance(fine) / std::min(settings_.accuracy, vibrating_share)) : e;
}

// One step of length h, and two half steps whose iterations start from its rates.  After a rejected step `between_` holds the
// rates at its middle, in which the hinges that start to flow already turn.
bool Simulation::step_twice(double h, bool again) {
    coarse_ = state_;
    fine_ = state_;
    if (!stepper_.step(coarse_, h, again ? between_.data() : state_.w.data(), Stepper::most_passes)) return false;
    for (size_t k = 0; k < between_.size(); k++) between_[k] = (state_.w[k] + coarse_.w[k]) / 2;
    // what vibrates within the step is guessed too poorly for one pass to keep its energy
    const int passes = stepper_.filters() ? Stepper::most_passes : 1;
    if (!stepper_.step(fine_, h / 2, between_.data(), passes)) return false;
    between_ = fine_.w;
    return stepper_.step(fine_, h / 2, coarse_.w.data(), passes);
}

bool Simulation::stalled(Record& record) {
    record.reason = advance_.stalled(state_.t, stepper_.solves());
    if (record.reason.empty()) return false;
    record.outcome = Outcome::stalled;
    return true;
}

// Whether an inaccurate step of the smallest length violates the energy balance, so that no later result would be meaningful.
bool Simulation::unbalanced(Record& record) const {
    const Energies after = energies(model_, fine_);
    // the work of the step itself counts: a drive that starts at speed does all of it in the first, smallest step
    const double work = std::max(work_max_, std::fabs(value(after.external_work)));
    const double reference = std::max(start_energy_ + work, negligible_energy_);
    const double missed = std::fabs(value(after.balance() - energies(model_, state_).balance()));
    if (!(missed > refused_share * reference)) return false;
    record.outcome = Outcome::step_collapsed;
    record.reason = lost_balance;
    if (!model_.drives.empty()) record.reason += driven_without_solution;
    return true;
}

bool Simulation::advance(double target, Record& record, const std::function<bool(double)>& poll) {
    Attempt rejected;
    while (state_.t < target) {
        const std::int64_t done = stepper_.solves() * model_.tree.bodies();
        if (done > poll_at_ && poll) {
            poll_at_ = done + poll_interval;
            if (!poll(state_.t)) {
                record.outcome = Outcome::cancelled;
                return false;
            }
        }
        if (stalled(record)) return false;
        const double stop = std::min(target, next_break()), left = stop - state_.t;
        const double ahead = std::min(h_, longest_part());
        const double wanted = ahead >= left * (1 - 1e-9) ? left : (ahead > left / 2 ? left / 2 : ahead);
        const StepBound::Step seen = resolved(wanted);
        const double h = seen.h;
        const bool last = h == left, cut = last || h < wanted || ahead < h_;
        const bool solved = step_twice(h, rejected.h > 0);
        const double e = solved ? error(coarse_, fine_) : INFINITY;
        const bool smallest = h <= settings_.minimum_step * 1.001;
        if (std::isnan(e)) {
            record.outcome = Outcome::not_finite;
            record.reason = "a joint coordinate is not a number";
            return false;
        }
        if (!solved && smallest) {
            record.outcome = Outcome::step_collapsed;
            record.reason = "the equations of a step did not converge at the smallest step";
            return false;
        }
        const double factor = e > 0 ? safety * std::pow(e, -1 / error_order(rejected, {h, e})) : growth_limit;
        const double next = std::clamp(h * std::clamp(factor, shrink_limit, growth_limit), settings_.minimum_step,
                                       settings_.maximum_step);
        if (e > 1 && !smallest) {
            record.rejected++;
            advance_.count(solved ? Attempted::inexact : Attempted::unsolved);
            rejected = solved ? Attempt{h, e} : Attempt{};
            h_ = std::min(next, 0.7 * h);
            if (h_ < settings_.minimum_step) h_ = settings_.minimum_step;
            continue;
        }
        if (e > 1 && unbalanced(record)) return false;
        rejected = {};
        if (e > 1) record.forced++;
        if (last) fine_.t = stop;
        const bool rested = resting();
        std::swap(state_, fine_);
        h_ = cut && e <= 1 ? std::max(h_, next) : next;
        std::fill(moved_.begin(), moved_.end(), NAN);
        if (seen.unresolved > 0 && (rested || resting())) {
            unseen_ = std::max(unseen_, seen.unresolved * settings_.accuracy * std::max(speed_, large_speed_));
        }
        record.steps++;
        advance_.count(e > 1 ? Attempted::inexact : Attempted::taken);
        watch(record);
        set_critical_damping(false);
    }
    return true;
}

// The next break at which a step must end; a break closer than the smallest step is included in the following step.
double Simulation::next_break() const {
    const auto next = std::lower_bound(breaks_.begin(), breaks_.end(), state_.t + settings_.minimum_step * (1 - 1e-6));
    return next == breaks_.end() ? INFINITY : *next;
}

// Longest step for the requested number of parts between two breaks: runs with different numbers of parts then differ in their
// steps even where breaks limit them.
double Simulation::longest_part() const {
    if (breaks_.empty() || settings_.parts < 2) return INFINITY;
    const auto next = std::lower_bound(breaks_.begin(), breaks_.end(), state_.t + settings_.minimum_step * (1 - 1e-6));
    const double since = next == breaks_.begin() ? begin_ : *(next - 1), until = next == breaks_.end() ? end_ : *next;
    return std::max((until - since) / settings_.parts, settings_.minimum_step);
}

// whether any hinge is at rest
bool Simulation::resting() const {
    return std::any_of(state_.hinge.begin(), state_.hinge.end(), [](const HingeState& h) { return !h.sliding; });
}

// Longest step, at most h, that resolves the variation of loads and drives within it.
StepBound::Step Simulation::resolved(double h) {
    if (bound_.empty()) return {h, 0};
    const double large = std::max(speed_, large_speed_);
    auto speed = [&](size_t group) {
        if (std::isnan(moved_[group])) moved_[group] = stepper_.moved_by(state_, grouped_[group]);
        return moved_[group] / large;
    };
    return bound_.dynamic(state_.t, h, settings_.accuracy, std::min(settings_.minimum_step, h), speed);
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
