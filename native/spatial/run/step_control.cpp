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
// Share of the tolerance in a step that a similar run has taken: that the error is a little larger is no reason to leave its steps.
constexpr double guided_share = 4;
// Error after which the step keeps its length.
constexpr double unchanged = 0.729;

constexpr std::int64_t poll_interval = 20'000;  // solves times rows between calls of `poll`: some 10 ms
// Number of consecutive impacts that shows that something cannot give way; and the number after which restitution is switched off.
// Restitution between parts that lock each other gives endless impacts with decreasing energy; their limit is persistent contact.
constexpr int most_strikes = 1000, most_bounces = 200;
// Largest energy imbalance of a step of elastic hinges over the energy supplied: a fifth of the default bound of a run.
constexpr double vibrating_share = 2e-4;
// Relative tolerance of what held rows must not do in the filter of an error.
constexpr double filter_tolerance = 1e-3;
// Relative rounding of times.
constexpr double rounding = 1e-9;

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

// Difference of the places and of the velocities of one step and two half steps, without vibration above the resolved frequency.
void Simulation::differ(const State& coarse, const State& fine, double& place, double& speed) {
    if (in_one_ || !prepare_filter(fine.last_step)) {
        place = worst_place(coarse, fine, true);
        speed = kinetic_norm(model_, coarse, &fine);
        return;
    }
    const size_t n = fine.velocity.size();
    moved_by_.resize(n);
    difference_.velocity.resize(n);
    difference_.pose = fine.pose;
    for (size_t i = 0; i < n; i++) {
        difference_.velocity[i] = coarse.velocity[i] - fine.velocity[i];
        moved_by_[i] = {rotation_vector(coarse.pose[i].q * conjugate(fine.pose[i].q)), coarse.pose[i].x - fine.pose[i].x};
    }
    filter_change(difference_.velocity);
    filter_change(moved_by_);
    speed = kinetic_norm(model_, difference_, nullptr);
    place = 0;
    for (const Twist& d : moved_by_) place = std::max({place, norm(d.v) / model_.length, norm(d.w)});
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            const double turned = std::fabs(stepper_.filter().along(j, k, moved_by_));
            place = std::max(place, model_.hinges[j].components[static_cast<size_t>(k)].freedom < 3 ? turned / model_.length : turned);
        }
    }
}

// Prepares the filter of vibration at the end of a step of length h just taken; false if all vibration counts.
bool Simulation::prepare_filter(double h) {
    if (!stepper_.elastic() || !std::isfinite(model_.resolved_frequency) || stepper_.stage().quasi_static) return false;
    stepper_.filter().prepare(model_.resolved_frequency, h);
    return true;
}

// filters velocities or small displacements
void Simulation::filter_change(std::vector<Twist>& change) {
    double largest = 0;
    for (const Twist& d : change) largest = std::max({largest, norm(d.v), model_.length * norm(d.w)});
    if (largest > 0) stepper_.filter().apply(change, filter_tolerance * largest);
}

double Simulation::error(const State& coarse, const State& fine) {
    double worst = 0, difference = 0;
    differ(coarse, fine, worst, difference);
    for (size_t j = 0; j < fine.hinge.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            worst = std::max(worst, fine.hinge[j].component[k].overrun - state_.hinge[j].component[k].overrun);
        }
    }
    double e = worst / scale_;
    const double speed = std::max(speed_, negligible_speed_);
    if (speed > 0) e = std::max(e, difference / speed);
    e /= lost_ > 0 || springs_back(fine) ? std::max(step_tolerance_, lost_tolerance) : (leading_ && !lead_->paired ? guided_share : 1) * step_tolerance_;
    if (stepper_.stage().quasi_static) return e;
    // an energy imbalance above the accuracy counts as an error of the step
    const double allowed = stepper_.elastic() ? std::min(settings_.accuracy, vibrating_share) : settings_.accuracy;
    e = std::max(e, unbalance(fine) / allowed);
    return in_one_ ? std::max(e, unchanged) : e;
}

// Energy imbalance of a step relative to the energy supplied to the structure, or what a hinge gives back of its dissipated energy: the
// mean of opposite moments at both ends of a step, times the flow in the sense of the later one, is negative.
double Simulation::unbalance(const State& fine) const {
    const Energies after = energies(model_, fine);
    const double reference = std::max(given(after), negligible_energy_ + lift_ * scale_ + rounding_share * after.kinetic);
    double wrong = std::fabs(after.balance() - balance_);
    for (size_t j = 0; stepper_.elastic() && j < model_.hinges.size(); j++) {
        wrong = std::max(wrong, dissipated(model_.hinges[j], state_.hinge[j]) - dissipated(model_.hinges[j], fine.hinge[j]));
    }
    return reference > 0 ? wrong / reference : 0;
}

// one step and two half steps; the half steps get the change of the velocities from the full step
bool Simulation::solve(double h) {
    stepper_.stage().settling = refused_ || state_.t <= state_.stage_start;
    stepper_.stage().lost = lost_ > 0;
    coarse_ = state_;
    passes_.clear();
    stepper_.keep(step_records_ ? &passes_ : nullptr);
    const std::vector<Twist>* guess = suggested(h);
    if (!stepper_.step(coarse_, h, guess)) {
        ahead_.forget();
        return false;
    }
    // a free flight that is repeated up to the closing of a contact needs no halves
    closing_ = state_.contact.held.empty() ? coarse_.contact.closing : 0;
    if (closing_ > 0 && length_.can_land(h)) return true;
    ahead_.compare(model_, state_.velocity, stepper_.end_velocity());
    keep_for_guide(h);
    const bool passed = next_output_ < outputs_.size() && outputs_[next_output_] <= state_.t + h * (1 + rounding);
    in_one_ = !passed && like_leader();
    if (in_one_) {
        fine_ = coarse_;
        closing_ = 0;
        return true;
    }
    const std::vector<Twist>& end = stepper_.end_velocity();
    guess_.resize(end.size());
    const bool from_rest = stepper_.stage().quasi_static;
    for (size_t i = 0; i < end.size(); i++) guess_[i] = from_rest ? end[i] : 0.5 * (state_.velocity[i] + end[i]);
    fine_ = state_;
    fine_.contact.expect_first_half(coarse_.contact);
    const std::vector<Twist> last = end;
    if (!stepper_.step(fine_, h / 2, &guess_)) return false;
    ahead_.see_half(state_.velocity, fine_.velocity, h / 2, stepper_.end_rates());
    closing_ = fine_.contact.closing;
    if (closing_ > 0) return true;
    if (passed) half_ = fine_;
    fine_.contact.expect_second_half(coarse_.contact);
    if (!stepper_.step(fine_, h / 2, &last)) return false;
    if (fine_.contact.closing > 0) closing_ = h / 2 + fine_.contact.closing;
    return true;
}

// The step of an impact: so short that only velocities change.
bool Simulation::strike(Record& record) {
    ahead_.forget();
    length_.struck();
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
    refused_ = true;
    record.rejected++;
    advance_.count(what);
}

void Simulation::accept(Record& record, bool exact) {
    refused_ = false;
    add_to_guide(exact);
    record.steps++;
    advance_.count(exact ? Attempted::taken : Attempted::inexact);
}

// The next step, at most to the target.
StepPlan Simulation::next_step(double target) {
    const double stop = std::min(target, next_break()), left = stop - state_.t;
    const double longest = std::min(planned(), longest_part()), wanted = length_.wanted(longest, left, leading_ != nullptr);
    const StepBound::Step seen = resolved(wanted);
    StepPlan plan = length_.plan(seen.h, wanted, longest, left);
    plan.stop = stop;
    plan.unresolved = seen.unresolved;
    return plan;
}

// Whether a step that closes a contact is repeated up to there.
bool Simulation::lands(const StepPlan& plan, Record& record) {
    if (closing_ <= 0 || !length_.land(plan.h, closing_)) return false;
    reject(record, Attempted::closing);
    return true;
}

// Whether a step is repeated because a condition is met before its end.
bool Simulation::overshoots(const StepPlan& plan, double share, int which) {
    if (share >= 1 || plan.smallest || jumps(which)) return false;
    advance_.count(Attempted::inexact);
    length_.end_at(share, plan.h);
    return true;
}

// Makes the end of the step just solved the present state.
void Simulation::take(const StepPlan& plan, double e, Record& record) {
    if (plan.last) fine_.t = plan.stop;
    const bool rested = resting();
    std::swap(state_, fine_);
    ahead_.see_step(fine_.velocity, state_.velocity, plan.h, stepper_.end_rates());
    length_.follow(plan, e, stepper_.stage().quasi_static);
    std::fill(moved_.begin(), moved_.end(), NAN);
    if (plan.unresolved > 0 && (rested || resting())) {
        unseen_ = std::max(unseen_, plan.unresolved * settings_.accuracy * std::max(speed_, large_speed_));
    }
    accept(record, e <= 1);
    overshot_ = NAN;
    watch(record);
    store_passed(record);
    strikes_ = 0;
}

bool Simulation::advance(double target, Record& record, const std::function<bool(double)>& poll) {
    while (state_.t < target) {
        if (cancelled(record, poll) || stalled(record)) return false;
        if (state_.contact.impact) {
            if (!strike(record)) return false;
            continue;
        }
        const StepPlan plan = next_step(target);
        const bool solved = solve(plan.h);
        if (solved && lands(plan, record)) continue;
        const double e = solved ? error(coarse_, fine_) : INFINITY;
        if (failed(e, plan.smallest, record)) return false;
        if (e > 1 && !plan.smallest) {
            reject(record, solved ? Attempted::inexact : Attempted::unsolved);
            length_.shorten(plan.h, e, stepper_.stage().quasi_static);
            continue;
        }
        int which = -1;
        const double share = share_of_step(state_, fine_, &which);
        if (overshoots(plan, share, which)) continue;
        if (e > 1 && !force(record)) return false;
        take(plan, e, record);
        if (lost(fine_, record)) return false;
        if (share <= 1) {
            record.ended_by = which;
            return false;
        }
        record_step(plan.h);
    }
    return true;
}

}  // namespace crumple::spatial
