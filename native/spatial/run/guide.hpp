// The accepted steps of a run, with which runs of similar models start theirs.
//
// Unlike a follower (step_record.hpp), a guided run solves the equations of every step; what it takes from the leader are the lengths of
// the steps, the starts of Newton's method, and the error of a step that changes the velocities as the leader's did.  Where it departs
// from the leader, it controls the error and goes on by itself.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
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
    std::shared_ptr<const Guide> parts;   // paired: the steps that pairs are made of, and the index of the first one of each
    std::vector<std::size_t> first_part;
    bool is_pair(std::size_t i) const { return paired && parts->steps[first_part[i]].end < steps[i].end; }
};

// Steps twice as long, for another run of the same model: pairs of accurate steps of similar length, without an impact between them, are one.
Guide in_pairs(std::shared_ptr<const Guide> steps);
// makes one step of two that follow on each other
void join(GuideStep& step, const GuideStep& next);

// Whether pairs of steps are taken one by one.  A pair that departs from the leader has cost a step and is repeated in halves, which are about
// the leader's two steps; where motion is smooth the next pairs depart as well.  After such a pair the next one is taken one by one, and twice
// as many after the next such pair.  Where single steps depart too, pairs are tried for a while: their halves control the error.
class OneByOne {
public:
    bool next() { return left_ > 0 && left_-- > 0; }
    void tried_pair(bool alike) {
        if (alike) {
            number_ = std::min(number_, 1);
        } else if (number_ < 1) {
            number_++;
        } else {
            left_ = number_;
            number_ = std::min(2 * number_, most);
        }
    }
    void single_departed() {
        left_ = 0;
        number_ = 1 - patience;
    }

private:
    static constexpr int most = 16, patience = 4;
    int left_ = 0, number_ = 1;  // pairs that are still taken one by one; number after the next pair that departs, not positive: none yet
};

}  // namespace crumple::spatial
