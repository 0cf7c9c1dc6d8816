// End velocities to expect of the next step, from the accelerations in the last one.
//
// The guess is accurate to first order, so the step needs one pass over its frozen quantities in place of two.  Only the step in one is
// guessed: its halves, which are kept, start from its solution.
#pragma once

#include <vector>

#include "spatial/model/model.hpp"

namespace crumple::spatial {

class Ahead {
public:
    // nothing is known after an impact or at the start of a stage
    void forget() { known_ = false; }
    // After the first half of a step, of this length.  If the step is rejected, its repetition is guessed from there.
    void see_half(const std::vector<Twist>& before, const std::vector<Twist>& after, double length, const std::vector<double>& rates);
    // after an accepted step in halves: its accelerations continue linearly
    void see_step(const std::vector<Twist>& before, const std::vector<Twist>& after, double length, const std::vector<double>& rates);
    // Finds the end velocities of a step from these velocities; false if nothing is known of steps of such a length, or if the last
    // guess was further from the solution than the velocities before the step.
    bool guess(const std::vector<Twist>& now, double length);
    const std::vector<Twist>& end() const { return end_; }
    // rates along all rows at the end of the last (half) step, which show what is locked
    const std::vector<double>& rates() const { return rates_; }
    // compares the last guess with the end velocities found, and forgets all accelerations
    void compare(const Model& model, const std::vector<Twist>& before, const std::vector<Twist>& found);

private:
    bool known_ = false, guessed_ = false, good_ = true;
    double length_ = 0;  // of the step that showed the accelerations
    std::vector<Twist> acceleration_, end_;
    std::vector<double> rates_;
};

}  // namespace crumple::spatial
