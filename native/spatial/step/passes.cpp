// Information that a pass over a step takes from the previous pass.
#include <algorithm>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

// Whether a coupled hinge came to rest or reversed in a step that assumed continued sliding: its rates then have another weight, see
// `FrozenSpatialHinge::lead`.
bool Stepper::turned_back() {
    bool any = false;
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!hinge_of(c)) continue;
        const FrozenSpatialHinge& f = frozen_[at(hinge_index(c))];
        if (f.lead == 0) continue;
        double along = 0;
        for (int k = 0; k < size(*hinge_of(c)); k++) along += f.w0[k] * w_[at(start(c) + system_.links()[c].held + k)];
        if (along > 0) continue;
        turned_back_[at(hinge_index(c))] = true;
        any = true;
    }
    return any;
}

// Newton's method starts from the guess, but hinges that were locked in the last pass start with the rates of that pass: these are far
// below the accuracy of a guess and give the hinges' shares of their capacity.  The laws are frozen with the guess alone.
void Stepper::keep_locked() {
    for (size_t c = 0; solved_ && c < connections_.size(); c++) {
        const size_t first = at(start(c) + system_.links()[c].held);
        if (!hinge_of(c) || load(c, &w_next_[first]) >= 1) continue;
        std::copy_n(&w_next_[first], system_.links()[c].laws, &w_[first]);
    }
}

}  // namespace crumple::spatial
