// The part of the contacts in a step, in addition to what all laws have in common.
#pragma once

#include <vector>

#include "spatial/solve/problem.hpp"

namespace crumple::spatial {

class ContactStep {
public:
    explicit ContactStep(Problem& problem) : p_(problem) {}

    void begin(const State& s);
    // shifts the normal rates by the allowed rates
    void allow_closing(double h);
    // after a pass: restores the true rates; returns whether friction has used the normal impulses that the pass found (`any_limits`: others will do)
    bool settle(bool any_limits);
    void commit(State& s, double h);
    // Adds the impulses on obstacles from the projection of the rates, in which contacts keep their tangents.
    void push_obstacles(State& s, double h);
    // error of a link's law row that the projection corrects: the overlap of a closed contact
    double overlap(size_t link) const;
    // Sets whether the state after a step of length h, whose rows have just been located, approaches a closed contact (impact); `search`:
    // and whether contacts were overlooked.
    void see(State& s, double h, bool search);

private:
    Problem& p_;
    double unbounded_ = 0;         // in an impact: rate of approach that is never reached; 0 in other steps
    std::vector<double> allowed_;  // allowed normal rate per contact in this pass
};

}  // namespace crumple::spatial
