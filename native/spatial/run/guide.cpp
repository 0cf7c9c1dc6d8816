// Runs that are guided by the steps of a run of a similar model, see guide.hpp.
#include <algorithm>
#include <cmath>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

namespace {

// Largest number of values that a guide keeps: 32 MB.
constexpr size_t most_values = 4'000'000;
// Relative difference of times that is rounding.
constexpr double rounding = 1e-9;
// A step of the leader is aimed at if at least this share of it is ahead.
constexpr double far_enough = 0.5;
// Difference from the leader's change of the velocities, as a share of it, up to which a step is not repeated in halves.
constexpr double alike = 0.1;

// Ratio of the lengths of two steps that are taken as one, at most.
constexpr double similar = 2.5;

bool make_pair(const GuideStep& a, const GuideStep& b) {
    const bool adjacent = std::fabs(b.begin - a.end) <= rounding * a.length();
    const double longer = std::max(a.length(), b.length()), shorter = std::min(a.length(), b.length());
    return adjacent && a.accurate && b.accurate && !b.struck && longer <= similar * shorter;
}

}  // namespace

Guide in_pairs(const Guide& steps) {
    Guide out;
    out.paired = true;
    for (size_t i = 0; i < steps.steps.size(); i++) {
        const GuideStep& step = steps.steps[i];
        out.steps.push_back(step);
        if (i + 1 == steps.steps.size() || !make_pair(step, steps.steps[i + 1])) continue;
        const GuideStep& second = steps.steps[++i];
        out.steps.back().end = second.end;
        out.steps.back().after = second.after;
        out.steps.back().to = second.to;
        out.steps.back().rates = second.rates;
    }
    return out;
}

// Length of the next step before other limits: that of the leader, or up to the end of one of its steps, or what the error suggests.
double Simulation::planned() {
    leading_ = nullptr;
    if (!lead_ || refused_ || !until_.empty() || stepper_.stage().quasi_static) return length_.allowed();
    const std::vector<GuideStep>& steps = lead_->steps;
    while (next_lead_ < steps.size() && steps[next_lead_].end - state_.t < far_enough * steps[next_lead_].length()) next_lead_++;
    if (next_lead_ == steps.size()) return length_.allowed();
    const GuideStep& next = steps[next_lead_];
    if (std::fabs(next.begin - state_.t) > rounding * next.length()) return std::min(length_.allowed(), next.end - state_.t);
    leading_ = &next;
    return next.end - state_.t;
}

// The end velocities that the leader suggests for a step of length h, its change of the velocities added; without a leader those that
// are expected; null if there are none.
const std::vector<Twist>* Simulation::suggested(double h) {
    if (leading_ && std::fabs(h - leading_->length()) > rounding * h) leading_ = nullptr;
    if (!leading_) return expected(h);
    guess_.resize(state_.velocity.size());
    for (size_t i = 0; i < guess_.size(); i++) guess_[i] = state_.velocity[i] + (leading_->after[i] - leading_->before[i]);
    stepper_.start_from(leading_->rates);
    return &guess_;
}

// The end velocities that the steps before suggest; null if there are none.
const std::vector<Twist>* Simulation::expected(double h) {
    predicted_ = Predicted::pass;
    if (followed_) return expected_by_follower(h);
    if (stepper_.stage().quasi_static || !ahead_.guess(state_.velocity, h)) return nullptr;
    stepper_.start_from(ahead_.rates());
    predicted_ = refused_ ? Predicted::change : Predicted::ahead;
    change_.clear();
    for (size_t i = 0; step_records_ && i < state_.velocity.size(); i++) change_.push_back(ahead_.end()[i] - state_.velocity[i]);
    return &ahead_.end();
}

// A follower predicts as its leader did.  Rejected steps are not repeated, so what they suggested is taken from the leader.
const std::vector<Twist>* Simulation::expected_by_follower(double h) {
    if (followed_->predicted == Predicted::pass) return nullptr;
    ahead_.guess(state_.velocity, h);
    if (followed_->predicted == Predicted::ahead) return &ahead_.end();
    guess_.resize(state_.velocity.size());
    for (size_t i = 0; i < guess_.size(); i++) guess_[i] = state_.velocity[i] + followed_->change[i];
    return &guess_;
}

void Simulation::keep_for_guide(double h) {
    if (!guide_) return;
    tried_ = {state_.t, state_.t + h, state_.velocity, stepper_.end_velocity(), stepper_.end_rates(), {}, {}, false, strikes_ > 0};
}

// Whether the step just solved in one changes the velocities as the leader's did: then it has the leader's error, up to that share of
// it.  Lengths make the rotations comparable, an inertia of a bar of the model's length.  Vibration above the resolved frequency does not
// count.
bool Simulation::like_leader() {
    if (!leading_ || !leading_->accurate || coarse_.contact.closing > 0) return false;
    // vibration of a changed model is soon in another phase: changes of the velocities do not compare
    if (stepper_.elastic() && !lead_->paired) return true;
    const size_t n = state_.velocity.size();
    std::vector<Twist> theirs(n), miss(n);
    for (size_t i = 0; i < n; i++) {
        theirs[i] = leading_->after[i] - leading_->before[i];
        miss[i] = stepper_.end_velocity()[i] - state_.velocity[i] - theirs[i];
    }
    const bool vibrates = prepare_filter(coarse_.last_step);
    if (vibrates) {
        filter_change(miss);
        filter_change(theirs);
    }
    const double missed = energy_norm(miss), gained = energy_norm(theirs);
    // a pair of steps of the same model is more accurate than one: the difference is the error
    const double error = (lead_->paired ? 1 : alike) * step_tolerance_ * speed_;
    if (lead_->paired) return missed <= error * error && travels_as_leader(vibrates);
    return missed <= error * error + alike * alike * gained;
}

// Twice the kinetic energy, with an inertia of a bar of the model's length.
double Simulation::energy_norm(const std::vector<Twist>& velocity) const {
    const double spread = model_.length * model_.length / 12;
    double sum = 0;
    for (size_t i = 0; i < velocity.size(); i++) {
        sum += model_.bodies[i].mass * (dot(velocity[i].v, velocity[i].v) + spread * dot(velocity[i].w, velocity[i].w));
    }
    return sum;
}

// Whether the bodies move by the step just solved as far as by the leader's, within the tolerance of a step.
bool Simulation::travels_as_leader(bool vibrates) {
    std::vector<Twist> miss(state_.pose.size());
    for (size_t i = 0; i < miss.size(); i++) {
        const Pose &from = leading_->from[i], &to = leading_->to[i];
        const Quat own = coarse_.pose[i].q * conjugate(state_.pose[i].q), theirs = to.q * conjugate(from.q);
        miss[i] = {rotation_vector(own * conjugate(theirs)), (coarse_.pose[i].x - state_.pose[i].x) - (to.x - from.x)};
    }
    if (vibrates) filter_change(miss);
    double worst = 0;
    for (const Twist& d : miss) worst = std::max({worst, norm(d.v) / model_.length, norm(d.w)});
    return worst <= step_tolerance_ * scale_;
}

void Simulation::add_to_guide(bool accurate) {
    if (!guide_ || !guide_->kept) return;
    tried_.end = state_.t;
    tried_.accurate = accurate;
    tried_.from = fine_.pose;
    tried_.to = state_.pose;
    guide_->steps.push_back(tried_);
    const size_t values = 26 * tried_.before.size() + tried_.rates.size();
    if (guide_->steps.size() * values <= most_values) return;
    guide_->steps.clear();
    guide_->kept = false;
}

}  // namespace crumple::spatial
