// Friction limits of the contacts of a step: the normal impulses that its next pass uses for them.
//
// A pass uses normal impulses u for the limits mu u of friction and finds normal impulses f(u); the step wants e(u) = f(u) - u = 0.
// Plain repetition, u + e, converges slowly, and alternates where friction is strong.  So this is Broyden's method: u - H e, where H is an
// estimate of the inverse of de/du that every pass improves by a matrix of rank one,
//     H += (s - H y) s^T H / (s^T H y),   s and y the changes of u and e.
// de/du has no unit and depends on places and on what slides, not on the length of the step: the next step begins with H of the last.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace crumple::spatial {

using std::size_t;

// H at the end of a step, row by row, and the keys of its contacts in increasing order.
struct LimitSlopes {
    std::vector<int64_t> key;
    std::vector<double> inverse;
};

class FrictionLimits {
public:
    // before the passes of a step over contacts with these keys, in increasing order
    void begin(const std::vector<int64_t>& key, const LimitSlopes& known);
    // `normal`: the impulses that the pass used on input, those that the next one uses on output
    void follow(std::vector<double>& normal, const std::vector<double>& found);
    // what the next step may know
    LimitSlopes slopes() const;

private:
    void repeat_plainly();
    void improve(const std::vector<double>& used, const std::vector<double>& error);

    std::vector<int64_t> key_;
    std::vector<double> inverse_, used_, error_;  // H; used by the last pass, and its e
    std::vector<double> change_, forward_, back_;  // s, H y and H^T s
    bool passed_ = false;                         // whether a pass of this step has been seen
};

}  // namespace crumple::spatial
