// The steps that a run took, so that runs of models near by can follow it.
//
// A follower takes the leader's steps and passes, and in place of Newton's iterations one Newton step from the
// leader's solution.  With R(w; s, p) = 0 the equations of a pass, w* the leader's solution, and s and p the follower's own
// state and parameters,
//     w = w* - (dR/dw)^-1 R(w*; s, p) ,
// so dw/dp = -(dR/dw)^-1 (dR/ds ds/dp + dR/dp): the implicit function theorem, with the laws on the pieces on which the
// leader found them.  Half the difference of two followers, one above and one below the leader, is this derivative up to
// the square of their distance; see docs/theory/sensitivities.md.
#pragma once

#include <vector>

namespace crumple::spatial {

// A pass over a step: rates along all rows once they had converged, those of hinges as their laws see them;
// `FrozenSpatialHinge::lead` of every hinge; and whether no pass followed.
struct Pass {
    std::vector<double> rates, lead;
    bool settled = false;
};

// An accepted step: its length and end [s], the passes of the whole and its halves, and which of the stops without a
// damper of their own were given one after it.
struct StepRecord {
    double length = 0, end = 0;
    std::vector<Pass> passes;
    std::vector<bool> soon;
};

using StepRecords = std::vector<StepRecord>;

}  // namespace crumple::spatial
