// Step limits by loads and drives: where steps end, and how long they may be.  See docs/theory/time_functions.md.
#include <algorithm>
#include <cmath>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

// Collects the loads and drives that vary with time and therefore limit the steps.
void Simulation::bound_steps() {
    bound_ = {};
    grouped_.clear();
    for (size_t k = 0; k < model_.loads.size(); k++) {
        const Curve& curve = model_.loads[k].value;
        const int group = bound_.add_load(curve.places(), curve.values());
        if (group < 0) continue;
        grouped_.resize(std::max(grouped_.size(), static_cast<size_t>(group) + 1));
        grouped_[static_cast<size_t>(group)].push_back(k);
    }
    moved_.assign(grouped_.size(), NAN);
    for (size_t k = 0; k < model_.drives.size(); k++) {
        const Curve& rate = model_.drives[k].rate;
        if (stepper_.stage().drives[k].acts) bound_.add_drive(rate.places(), rate.values());
    }
    if (grouped_.empty()) return;
    if (!weigher_) weigher_.emplace(model_);
    weigher_->stage() = stepper_.stage();
}

// The next break at which a step must end; a break closer than the smallest step is included in the following step.
double Simulation::next_break() const {
    const double since = state_.t - state_.stage_start;
    const auto next = std::lower_bound(model_.breaks.begin(), model_.breaks.end(), since + settings_.minimum_step * (1 - 1e-6));
    return next == model_.breaks.end() ? INFINITY : state_.stage_start + *next;
}

// Longest step for the requested number of parts between two breaks: runs with different numbers of parts then differ in their
// steps even where breaks limit them.
double Simulation::longest_part() const {
    const std::vector<double>& breaks = model_.breaks;
    if (breaks.empty() || settings_.parts < 2) return INFINITY;
    const double now = state_.t - state_.stage_start + settings_.minimum_step * (1 - 1e-6);
    const auto next = std::lower_bound(breaks.begin(), breaks.end(), now);
    const double since = next == breaks.begin() ? 0 : *(next - 1), until = next == breaks.end() ? end_ : *next;
    return std::max((until - since) / settings_.parts, settings_.minimum_step);
}

// whether any hinge is at rest
bool Simulation::resting() const {
    for (size_t j = 0; j < model_.hinges.size(); j++) {
        for (int k = 0; k < size(model_.hinges[j]); k++) {
            if (!state_.hinge[j].component[k].sliding) return true;
        }
    }
    return false;
}

// Longest step, at most h, that resolves the variation of loads and drives within it.
StepBound::Step Simulation::resolved(double h) {
    if (bound_.empty()) return {h, 0};
    const double since = state_.t - state_.stage_start, least = std::min(settings_.minimum_step, h);
    if (stepper_.stage().quasi_static) return bound_.quasi_static(since, h, settings_.accuracy, least);
    const double large = std::max(speed_, large_speed_);
    auto speed = [&](size_t group) {
        if (std::isnan(moved_[group])) moved_[group] = weigher_->moved_by(state_, grouped_[group]);
        return moved_[group] / large;
    };
    return bound_.dynamic(since, h, settings_.accuracy, least, speed);
}

}  // namespace crumple::spatial
