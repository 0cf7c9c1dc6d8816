#include "spatial/step/pass_records.hpp"

namespace crumple::spatial {

bool PassRecords::settled(const Problem& problem, bool settled) {
    if (kept_) {
        Pass pass{problem.w, {}, settled};
        for (const FrozenSpatialHinge& f : problem.frozen) pass.lead.push_back(f.lead);
        for (size_t c = 0; c < problem.connections.size(); c++) {
            const size_t first = static_cast<size_t>(problem.start(c) + problem.system.links()[c].held);
            if (problem.hinge_of(c)) problem.seen_rate(c, &problem.w[first], &pass.rates[first]);
        }
        kept_->push_back(pass);
    }
    return followed_ ? (*followed_)[next_++].settled : settled;
}

bool PassRecords::solve(Problem& problem, NewtonSolver& newton) const {
    const Pass& leader = (*followed_)[next_];
    // another number of rows: friction in one of both models alone
    if (leader.rates.size() != problem.w.size()) return false;
    problem.w = leader.rates;
    for (size_t c = 0; c < problem.connections.size(); c++) {
        if (!problem.hinge_of(c)) continue;
        const size_t hinge = static_cast<size_t>(problem.hinge_index(c));
        FrozenSpatialHinge& f = problem.frozen[hinge];
        // hinges at rest and sliding hinges weight their rates differently; a follower's hinge is in the state of the leader's
        if (f.lead == 0 || leader.lead[hinge] == 0) f.lead = leader.lead[hinge];
        double* w = &problem.w[static_cast<size_t>(problem.start(c) + problem.system.links()[c].held)];
        for (int k = 0; k < size(*problem.hinge_of(c)); k++) w[k] = (w[k] - f.lead * f.w0[k]) / (1 - f.lead);
    }
    return newton.solve_linear();
}

}  // namespace crumple::spatial
