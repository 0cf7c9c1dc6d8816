// The steps of a run, stored so that runs of similar models can follow them.
//
// A follower uses the leader's steps and passes, and instead of Newton's iterations a single Newton step from the leader's
// solution.  With R(w; s, p) = 0 the equations of a pass, w* the leader's solution, and s and p the follower's own state
// and parameters,
//     w = w* - (dR/dw)^-1 R(w*; s, p) ,
// so that dw/dp = -(dR/dw)^-1 (dR/ds ds/dp + dR/dp): the implicit function theorem, with every law on the branch of the
// leader's solution.  Half the difference of two followers, one above and one below the leader, is this derivative up to
// the square of their distance; see docs/theory/sensitivities.md.
#pragma once

#include <vector>

#include "spatial/model/math.hpp"

namespace crumple::spatial {

// A pass over a step: converged rates along all rows, for hinges the rates w_e in their laws; `FrozenSpatialHinge::lead` of every
// hinge; and whether contacts and sliding hinges needed no further pass.
struct Pass {
    std::vector<double> rates, lead;
    bool settled = false;
};

// How the velocities at the end of a step were predicted: by a pass, as the accepted step before it suggests, or by the change of the
// velocities in a rejected step.
enum class Predicted { pass, ahead, change };

// An accepted step: its length and end [s], how it was predicted, the passes of the full step and its halves, and which of the stops with critical damping got a new damper after it.
struct StepRecord {
    double length = 0, end = 0;
    Predicted predicted = Predicted::pass;
    std::vector<Twist> change;
    std::vector<Pass> passes;
    std::vector<bool> soon;
};

using StepRecords = std::vector<StepRecord>;

}  // namespace crumple::spatial
