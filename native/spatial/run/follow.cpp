// Passes of a run that follows the steps of another run, see step_record.hpp.
#include <cmath>

#include "spatial/run/simulation.hpp"

namespace crumple::spatial {

void Stepper::keep_pass(bool settled) {
    Pass pass{w_, {}, settled};
    for (const FrozenSpatialHinge& f : frozen_) pass.lead.push_back(f.lead);
    for (size_t c = 0; c < connections_.size(); c++) {
        const size_t first = static_cast<size_t>(start(c) + system_.links()[c].held);
        if (hinge_of(c)) seen_rate(c, &w_[first], &pass.rates[first]);
    }
    kept_->push_back(pass);
}

bool Stepper::follow_pass() {
    const Pass& leader = (*followed_)[next_pass_];
    // another number of rows: friction in one of both models alone
    if (leader.rates.size() != w_.size()) return false;
    w_ = leader.rates;
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!hinge_of(c)) continue;
        const size_t hinge = static_cast<size_t>(hinge_index(c));
        FrozenSpatialHinge& f = frozen_[hinge];
        // hinges at rest and sliding hinges weight their rates differently; a follower's hinge is in the state of the leader's
        if (f.lead == 0 || leader.lead[hinge] == 0) f.lead = leader.lead[hinge];
        double* w = &w_[static_cast<size_t>(start(c) + system_.links()[c].held)];
        for (int k = 0; k < size(*hinge_of(c)); k++) w[k] = (w[k] - f.lead * f.w0[k]) / (1 - f.lead);
    }
    solve_once();
    velocity_.swap(next_);
    w_.swap(w_next_);
    double sum = 0;
    for (const Twist& v : velocity_) sum += dot(v.w, v.w) + dot(v.v, v.v);
    return std::isfinite(sum);
}

bool Simulation::follow(const StepRecords& steps) {
    Record record;
    make_ready();
    if (!steps.empty()) prepare(steps.back().end);
    for (const StepRecord& step : steps) {
        stepper_.follow(&step.passes);
        const bool solved = solve(step.length);
        stepper_.follow(nullptr);
        if (!solved) return false;
        std::swap(state_, fine_);
        state_.t = step.end;
        watch(record);
        set_critical_damping(step.soon);
    }
    return true;
}

}  // namespace crumple::spatial
