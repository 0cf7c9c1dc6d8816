// Step control: error estimate from one step and two half steps, impacts, shorter steps if the error is too large, ends at breaks.
#include <algorithm>
#include <cmath>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

namespace {

// Error allowed in one step, measured by the difference between one step and two half steps.  The local error is proportional to h^3
// and the error of the whole motion to h^2, so below `loosest_share` the error allowed in a step is reduced by a further factor, the
// square root of accuracy/loosest_share, as in the planar kernel.  With the full accuracy for each step, problem M3 just reaches it.
constexpr double loosest_share = 1e-3, step_share = 0.4;

// The same out of equilibrium in a quasi-static stage, where the path is only an estimate because inertia is neglected.
constexpr double lost_tolerance = 2e-2;

constexpr double safety = 0.9, shrink_limit = 0.2, growth_limit = 4;
constexpr std::int64_t poll_interval = 20'000;  // solves times rows between calls of `poll`: some 10 ms
// Number of consecutive impacts that shows that something cannot give way; and the number after which restitution is switched off.
// Restitution between parts that lock each other gives endless impacts with decreasing energy; their limit is persistent contact.
constexpr int most_strikes = 1000, most_bounces = 200;
// Steps are not shortened below this multiple of the smallest step to end at the closing of a contact.
constexpr double shortest_landing = 4;

}  // namespace

double step_tolerance(double accuracy) { return step_share * accuracy * std::min(1.0, std::sqrt(accuracy / loosest_share)); }

double kinetic_norm(const Model& model, const State& a, const State* b) {
    double e = 0;
    for (size_t i = 0; i < model.bodies.size(); i++) {
        const Body& body = model.bodies[i];
        if (!b && body.obstacle) continue;
        const Twist v = b ? a.velocity[i] - b->velocity[i] : a.velocity[i];
        const Vec3 w = turned(conjugate(a.pose[i].q), v.w);
        e += body.mass * dot(v.v, v.v) + dot(w, body.inertia * w);
    }
    return std::sqrt(e);
}

double Simulation::error(const State& coarse, const State& fine) const {
    double worst = worst_place(coarse, fine, true);
    for (size_t j = 0; j < fine.hinge.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            worst = std::max(worst, fine.hinge[j].component[k].overrun - state_.hinge[j].component[k].overrun);
        }
    }
    double e = worst / scale_;
    const double speed = std::max(speed_, negligible_speed_);
    if (speed > 0) e = std::max(e, kinetic_norm(model_, coarse, &fine) / speed);
    e /= lost_ > 0 ? std::max(step_tolerance_, lost_tolerance) : step_tolerance_;
    if (stepper_.stage().quasi_static) return e;
    // an energy imbalance above the accuracy counts as an error of the step
    return std::max(e, unbalance(fine) / settings_.accuracy);
}

// Energy imbalance of a step relative to the energy supplied to the structure.
double Simulation::unbalance(const State& fine) const {
    const Energies after = energies(model_, fine);
    const double reference = std::max(given(after), negligible_energy_ + lift_ * scale_ + rounding_share * after.kinetic);
    return reference > 0 ? std::fabs(after.balance() - balance_) / reference : 0;
}

// one step and two half steps; the half steps get the change of the velocities from the full step
bool Simulation::solve(double h) {
    coarse_ = state_;
    passes_.clear();
    stepper_.keep(step_records_ ? &passes_ : nullptr);
    if (!stepper_.step(coarse_, h, nullptr)) return false;
    const std::vector<Twist>& end = stepper_.end_velocity();
    guess_.resize(end.size());
    const bool from_rest = stepper_.stage().quasi_static;
    for (size_t i = 0; i < end.size(); i++) guess_[i] = from_rest ? end[i] : 0.5 * (state_.velocity[i] + end[i]);
    fine_ = state_;
    const std::vector<Twist> last = end;
    if (!stepper_.step(fine_, h / 2, &guess_)) return false;
    closing_ = fine_.contact.closing;
    if (closing_ > 0) return true;
    if (!stepper_.step(fine_, h / 2, &last)) return false;
    if (fine_.contact.closing > 0) closing_ = h / 2 + fine_.contact.closing;
    return true;
}

// The step of an impact: so short that only velocities change.
bool Simulation::strike(Record& record) {
    stepper_.contacts().set_bounces(strikes_ < most_bounces);
    const bool solved = stepper_.step(state_, settings_.minimum_step, nullptr);
    stepper_.contacts().set_bounces(true);
    if (!solved) {
        record.outcome = Outcome::step_collapsed;
        record.reason = "the equations of an impact did not converge";
        return false;
    }
    record.steps++;
    advance_.count(Attempted::impact);
    watch(record);
    if (++strikes_ <= most_strikes) return true;
    record.outcome = Outcome::step_collapsed;
    record.reason = "impacts follow on each other without end: an obstacle or a driven part presses on what cannot give way";
    return false;
}

// Whether a step of error e (infinite: not solved) cannot be replaced by a shorter one.
bool Simulation::failed(double e, bool smallest, Record& record) const {
    if (std::isnan(e)) {
        record.outcome = Outcome::not_finite;
        record.reason = "the place of a body is not a number";
        return true;
    }
    if (std::isfinite(e) || !smallest) return false;
    record.outcome = Outcome::step_collapsed;
    record.reason = "the equations of a step did not converge at the smallest step";
    if (!model_.drives.empty()) record.reason += driven_without_solution;
    return true;
}

// Whether an inaccurate step of the smallest length may be accepted: not if it violates the energy balance, because no later result
// would be meaningful.
bool Simulation::force(Record& record) const {
    record.forced++;
    if (stepper_.stage().quasi_static || unbalance(fine_) <= refused_share) return true;
    record.outcome = Outcome::step_collapsed;
    record.reason = lost_balance;
    if (!model_.drives.empty()) record.reason += driven_without_solution;
    return false;
}

// Calls `poll` at intervals.
bool Simulation::cancelled(Record& record, const std::function<bool(double)>& poll) {
    const std::int64_t done = stepper_.solves() * std::max(1, stepper_.rows());
    if (done <= poll_at_ || !poll) return false;
    poll_at_ = done + poll_interval;
    if (poll(state_.t)) return false;
    record.outcome = Outcome::cancelled;
    return true;
}

void Simulation::reject(Record& record, Attempted what) {
    record.rejected++;
    advance_.count(what);
}

void Simulation::accept(Record& record, bool exact) {
    record.steps++;
    advance_.count(exact ? Attempted::taken : Attempted::inexact);
}

bool Simulation::advance(double target, Record& record, const std::function<bool(double)>& poll) {
    while (state_.t < target) {
        if (cancelled(record, poll) || stalled(record)) return false;
        if (state_.contact.impact) {
            if (!strike(record)) return false;
            continue;
        }
        const double stop = std::min(target, next_break()), left = stop - state_.t;
        const double longest = std::min(h_, longest_part()), ahead = landing_ > 0 ? std::min(landing_, longest) : longest;
        const double wanted = ahead >= left * (1 - 1e-9) ? left : (ahead > left / 2 && landing_ == 0 ? left / 2 : ahead);
        const StepBound::Step seen = resolved(wanted);
        const double h = seen.h;
        const bool last = h == left, cut = last || h < wanted || longest < h_ || landing_ > 0;
        const bool solved = solve(h);
        if (solved && closing_ > 0 && h > shortest_landing * settings_.minimum_step) {
            reject(record, Attempted::closing);
            landing_ = std::max(closing_, settings_.minimum_step);
            continue;
        }
        const double e = solved ? error(coarse_, fine_) : INFINITY;
        const bool smallest = h <= settings_.minimum_step * 1.001;
        if (failed(e, smallest, record)) return false;
        const double factor = e > 0 ? safety * std::pow(e, -1.0 / 3) : growth_limit;
        const double next = std::clamp(h * std::clamp(factor, shrink_limit, growth_limit), settings_.minimum_step,
                                       settings_.maximum_step);
        if (e > 1 && !smallest) {
            reject(record, solved ? Attempted::inexact : Attempted::unsolved);
            h_ = std::max(std::min(next, 0.7 * h), settings_.minimum_step);
            landing_ = 0;
            continue;
        }
        int which = -1;
        const double share = share_of_step(state_, fine_, &which);
        if (share < 1 && !smallest && !jumps(which)) {
            advance_.count(Attempted::inexact);
            h_ = std::max(share * h, settings_.minimum_step);
            landing_ = 0;
            continue;
        }
        if (e > 1 && !force(record)) return false;
        if (last) fine_.t = stop;
        const bool rested = resting();
        std::swap(state_, fine_);
        h_ = cut && e <= 1 ? std::max(h_, next) : next;
        std::fill(moved_.begin(), moved_.end(), NAN);
        landing_ = 0;
        if (seen.unresolved > 0 && (rested || resting())) {
            unseen_ = std::max(unseen_, seen.unresolved * settings_.accuracy * std::max(speed_, large_speed_));
        }
        accept(record, e <= 1);
        overshot_ = NAN;
        watch(record);
        strikes_ = 0;
        if (lost(fine_, record)) return false;
        if (share <= 1) {
            record.ended_by = which;
            return false;
        }
        record_step(h);
    }
    return true;
}

}  // namespace crumple::spatial
