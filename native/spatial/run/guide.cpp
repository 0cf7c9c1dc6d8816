// Runs that are guided by the steps of a run of a similar model, see guide.hpp.
#include <algorithm>
#include <cmath>
#include <utility>

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

void join(GuideStep& step, const GuideStep& next) {
    step.end = next.end;
    step.after = next.after;
    step.to = next.to;
    step.rates = next.rates;
    step.accurate = step.accurate && next.accurate;
}

Guide in_pairs(std::shared_ptr<const Guide> steps) {
    Guide out;
    out.paired = true;
    const std::vector<GuideStep>& all = steps->steps;
    for (size_t i = 0; i < all.size(); i++) {
        out.steps.push_back(all[i]);
        out.first_part.push_back(i);
        if (i + 1 < all.size() && make_pair(all[i], all[i + 1])) join(out.steps.back(), all[++i]);
    }
    out.parts = std::move(steps);
    return out;
}

// Length of the next step before other limits: that of the leader, or up to the end of one of its steps, or what the error suggests.
double Simulation::planned() {
    leading_ = nullptr;
    on_second_part_ = false;
    if (!lead_ || refused_ || !until_.empty() || stepper_.stage().quasi_static) return length_.allowed();
    const std::vector<GuideStep>& steps = lead_->steps;
    const GuideStep* second = std::exchange(second_part_, nullptr);
    on_second_part_ = begins_here(second);
    if (on_second_part_) return lead_by(*second);
    while (next_lead_ < steps.size() && steps[next_lead_].end - state_.t < far_enough * steps[next_lead_].length()) next_lead_++;
    if (next_lead_ == steps.size()) return length_.allowed();
    const GuideStep& next = steps[next_lead_];
    if (!begins_here(&next)) return std::min(length_.allowed(), next.end - state_.t);
    if (!lead_->is_pair(next_lead_) || !one_by_one_.next()) return lead_by(next);
    const GuideStep* part = &lead_->parts->steps[lead_->first_part[next_lead_]];
    second_part_ = part + 1;
    return lead_by(*part);
}

bool Simulation::begins_here(const GuideStep* step) const {
    return step && std::fabs(step->begin - state_.t) <= rounding * step->length();
}

double Simulation::lead_by(const GuideStep& step) {
    leading_ = &step;
    return step.end - state_.t;
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

// Whether the step just solved needs no halves because a leader's step shows its error.
bool Simulation::like_leader() {
    if (!leading_ || !leading_->accurate || coarse_.contact.closing > 0) return false;
    const bool pair = lead_->is_pair(next_lead_) && leading_ == &lead_->steps[next_lead_];
    // vibration of a changed model, or after other steps, is soon in another phase: changes of the velocities do not compare
    if (stepper_.elastic() && !pair) return true;
    const bool found = changes_as_leader(pair);
    if (pair) {
        one_by_one_.tried_pair(found);
    } else if (lead_->paired && !found) {
        one_by_one_.single_departed();
    }
    return found;
}

// Whether the step just solved in one changes the velocities as the leader's did: then it has the leader's error, up to that share of
// it.  Lengths make the rotations comparable, an inertia of a bar of the model's length.  Vibration above the resolved frequency does not
// count.
bool Simulation::changes_as_leader(bool pair) {
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
    const double error = (lead_->paired ? 1 : alike) * step_tolerance_ * speed_;
    // a pair of steps of the same model is more accurate than one: the difference is the error
    if (pair) return missed <= error * error && travels_as_leader(vibrates);
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

// Whether the step just taken and the one before it are a pair of the leader: to those who follow they are one step.
bool Simulation::completes_pair() const {
    if (!leading_ || !on_second_part_ || guide_->steps.empty()) return false;
    const GuideStep &pair = lead_->steps[next_lead_], &before = guide_->steps.back();
    return before.accurate && tried_.accurate && !tried_.struck && std::fabs(before.begin - pair.begin) <= rounding * pair.length();
}

void Simulation::add_to_guide(bool accurate) {
    if (!guide_ || !guide_->kept) return;
    tried_.end = state_.t;
    tried_.accurate = accurate;
    tried_.from = fine_.pose;
    tried_.to = state_.pose;
    if (completes_pair()) {
        join(guide_->steps.back(), tried_);
    } else {
        guide_->steps.push_back(tried_);
    }
    const size_t values = 26 * tried_.before.size() + tried_.rates.size();
    if (guide_->steps.size() * values <= most_values) return;
    guide_->steps.clear();
    guide_->kept = false;
}

}  // namespace crumple::spatial
