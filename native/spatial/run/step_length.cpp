#include "spatial/run/step_length.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Limits of the change from one step to the next.  In motion, where hinges lock and slide, steps that grow faster are rejected more often.
// (With a factor of two, multiples of the first step meet the end of the run, and rounding decides how it is divided.)
constexpr double safety = 0.9, shrink_limit = 0.2, growth_limit = 4, growth_in_motion = 2.2;
// Error above which two rejected lengths show its order, and the least share of the second that the next one may be.
constexpr double large_error = 10, shrink_limit_of_order = 0.02;
// Order of the error of a step: of a motion without events, and least.
constexpr double most_order = 3, least_order = 1;
// Steps are not shortened below this multiple of the smallest step to end at the closing of a contact.
constexpr double shortest_landing = 4;
// Landings in a row that fall short before the closing times found are doubled, once for each further one; and number that is counted.
constexpr int patient_landings = 3, most_landings = 30;
// In motion the factor is rounded down to whole parts: the error of a step in which hinges lock has few digits, and rounding in the moments that
// equilibrium does not determine would otherwise change the lengths of all later steps.
constexpr double parts_of_factor = 1024;
// A rejected step is replaced by one of at most this share of its length; a whole share of the time left that is rounding.
constexpr double shorter = 0.7, whole = 1 - 1e-9;

double whole_parts(double factor) { return std::floor(factor * parts_of_factor) / parts_of_factor; }

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

bool StepLength::can_land(double h) const { return h > shortest_landing * least_; }

bool StepLength::land(double h, double closing) {
    if (!can_land(h)) return false;
    // this step was to end there, and went too far
    if (landing_ > 0) short_landings_ = 0;
    const double further = std::ldexp(closing, std::max(short_landings_ - patient_landings, 0));
    landing_ = std::max({closing, std::min(further, h / 2), least_});
    return true;
}

double StepLength::after(double h, double e, bool quasi_static) const {
    const double most = quasi_static ? growth_limit : growth_in_motion;
    const double factor = e > 0 ? safety * std::pow(e, -1 / most_order) : most;
    const double bounded = std::clamp(factor, shrink_limit, most);
    return std::clamp(h * (quasi_static ? bounded : whole_parts(bounded)), least_, most_);
}

void StepLength::shorten(double h, double e, bool quasi_static) {
    double next = std::min(after(h, e, quasi_static), shorter * h);
    // an event near the start of the step leaves an error of first order: two rejected lengths show it
    if (!quasi_static && e > large_error && refused_error_ > e && std::isfinite(refused_error_)) {
        const double order = std::clamp(std::log(refused_error_ / e) / std::log(refused_ / h), least_order, most_order);
        next = std::min(next, h * whole_parts(std::max(safety * std::pow(e, -1 / order), shrink_limit_of_order)));
    }
    refused_ = h;
    refused_error_ = e;
    h_ = std::max(next, least_);
    landing_ = 0;
}

void StepLength::end_at(double share, double h) {
    h_ = std::max(share * h, least_);
    landing_ = 0;
}

void StepLength::follow(const StepPlan& plan, double e, bool quasi_static) {
    short_landings_ = landing_ > 0 ? std::min(short_landings_ + 1, most_landings) : 0;
    const double next = after(plan.h, e, quasi_static);
    h_ = plan.cut && e <= 1 ? std::max(h_, next) : next;
    landing_ = 0;
    refused_error_ = 0;
}

}  // namespace crumple::spatial
