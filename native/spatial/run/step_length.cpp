#include "spatial/run/step_length.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Limits of the change from one step to the next.  In motion, where hinges lock and slide, steps that grow faster are rejected more often.
// (With a factor of two, multiples of the first step meet the end of the run, and rounding decides how it is divided.)
constexpr double safety = 0.9, shrink_limit = 0.2, growth_limit = 4, growth_in_motion = 2.2;
// Steps are not shortened below this multiple of the smallest step to end at the closing of a contact.
constexpr double shortest_landing = 4;
// In motion the factor is rounded down to whole parts: the error of a step in which hinges lock has few digits, and rounding in the moments that
// equilibrium does not determine would otherwise change the lengths of all later steps.
constexpr double parts_of_factor = 1024;
// A rejected step is replaced by one of at most this share of its length; a whole share of the time left that is rounding.
constexpr double shorter = 0.7, whole = 1 - 1e-9;

}  // namespace

void StepLength::begin(double duration) {
    if (h_ <= 0) h_ = std::clamp(duration / 100, least_, most_);
}

double StepLength::wanted(double longest, double left, bool aimed) const {
    const double ahead = landing_ > 0 ? std::min(landing_, longest) : longest;
    if (ahead >= left * whole) return left;
    return ahead > left / 2 && landing_ == 0 && !aimed ? left / 2 : ahead;
}

StepPlan StepLength::plan(double h, double wanted, double longest, double left) const {
    StepPlan out;
    out.h = h;
    out.last = h == left;
    out.cut = out.last || h < wanted || longest < h_ || landing_ > 0;
    out.smallest = h <= least_ * 1.001;
    return out;
}

bool StepLength::land(double h, double closing) {
    if (h <= shortest_landing * least_) return false;
    landing_ = std::max(closing, least_);
    return true;
}

double StepLength::after(double h, double e, bool quasi_static) const {
    const double most = quasi_static ? growth_limit : growth_in_motion;
    const double factor = e > 0 ? safety * std::pow(e, -1.0 / 3) : most;
    const double bounded = std::clamp(factor, shrink_limit, most);
    const double whole_parts = quasi_static ? bounded : std::floor(bounded * parts_of_factor) / parts_of_factor;
    return std::clamp(h * whole_parts, least_, most_);
}

void StepLength::shorten(double h, double e, bool quasi_static) {
    h_ = std::max(std::min(after(h, e, quasi_static), shorter * h), least_);
    landing_ = 0;
}

void StepLength::end_at(double share, double h) {
    h_ = std::max(share * h, least_);
    landing_ = 0;
}

void StepLength::follow(const StepPlan& plan, double e, bool quasi_static) {
    const double next = after(plan.h, e, quasi_static);
    h_ = plan.cut && e <= 1 ? std::max(h_, next) : next;
    landing_ = 0;
}

}  // namespace crumple::spatial
