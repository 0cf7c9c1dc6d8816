// The accepted steps of a run, with which runs of similar models start theirs.
//
// Unlike a follower (step_record.hpp), a guided run solves the equations of every step; what it takes from the leader are the lengths of
// the steps, the starts of Newton's method, and the error of a step that changes the velocities as the leader's did.  Where it departs
// from the leader, it controls the error and goes on by itself.
#pragma once

#include <vector>

#include "spatial/model/math.hpp"

namespace crumple::spatial {

// A step: its ends [s], the velocities of the bodies there as the step in one found them, its rates along all rows, and the places of
// the bodies at the ends of the accepted step.
struct GuideStep {
    double begin = 0, end = 0;
    std::vector<Twist> before, after;
    std::vector<double> rates;
    std::vector<Pose> from, to;
    bool accurate = false;  // whether its error was within its tolerance
    bool struck = false;    // whether an impact came just before it
    double length() const { return end - begin; }
};

struct Guide {
    std::vector<GuideStep> steps;
    bool kept = true;     // false: too many steps to keep, none are
    bool paired = false;  // see `in_pairs`
};

// Steps twice as long, for another run of the same model: pairs of accurate steps of similar length, without an impact between them, are one.
Guide in_pairs(const Guide& steps);

}  // namespace crumple::spatial
