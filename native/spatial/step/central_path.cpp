// The end velocities of a step along the central path: for steps in which many hinges lock, slide and turn at once.
//
// Every hinge has a point of its own (central.hpp); the bodies' velocities are those of the problem linearised at the points, so
// only the points know how far along the path they are.  Newton steps go on while mu falls; each point goes as far towards its
// next one as keeps it inside, by itself, or, where that loses the way, all by the same share.  The end of the path is a
// start for full steps on the laws themselves, which decide alone whether the step is solved.
#include <algorithm>
#include <cmath>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// mu where a path begins, where one is kept for the passes to come, and where one ends, over the largest rate.
constexpr double path_begin = 1e-1, path_kept = 1e-4, path_end = 1e-11;
// At the end s (1 - g^2) is within this factor of mu, and all points went at least this share of their way.
constexpr double close_to_end = 2, nearly_whole = 0.7;
// mu falls by the first factor where all points went half their way, by the second where they went a tenth of it.
constexpr double fast = 0.03, fast_together = 0.1, slow = 0.3;
constexpr double half_way = 0.5, some_way = 0.1;
// Newton steps before a path is lost, each way; and growth of the mean s (1 - g^2) that indicates the same.
constexpr int path_limit = 16, path_limit_together = 60;
constexpr double lost = 10;
// full steps on the laws, from the path's end
constexpr int polish_limit = 12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

// Points as the last path of this step left them, or from the moments of the last step and the guessed rates; the largest rate.
double Stepper::enter_path(bool warm) {
    double largest = 0;
    on_path_.assign(connections_.size(), 0);
    point_.resize(frozen_.size());
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!hinge_of(c) || !has_path(*hinge_of(c), frozen_[at(hinge_index(c))])) continue;
        on_path_[c] = 1;
        const double* w = &w_[at(start(c) + system_.links()[c].held)];
        for (int k = 0; k < system_.links()[c].laws; k++) largest = std::max(largest, std::fabs(w[k]));
    }
    warm = warm && kept_mu_ > 0;
    mu_ = warm ? kept_mu_ : path_begin * largest;
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!on_path_[c]) continue;
        const size_t hinge = at(hinge_index(c));
        const FrozenSpatialHinge& f = frozen_[hinge];
        double impulse[most_components];
        for (int k = 0; k < size(*hinge_of(c)); k++) impulse[k] = f.h * f.tau0[k];
        point_[hinge] = warm ? kept_point_[hinge] : near_path(*hinge_of(c), f, impulse, &w_[at(start(c) + system_.links()[c].held)], mu_);
    }
    kept_mu_ = 0;
    return largest;
}

// One Newton step; the mean of s (1 - g^2), and the least share of its way that a point went.
double Stepper::step_on_path(bool together, double& least) {
    solve_once();
    velocity_.swap(next_);
    w_.swap(w_next_);
    next_point_.resize(point_.size());
    share_.assign(point_.size(), 1.0);
    least = 1;
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!on_path_[c]) continue;
        const size_t hinge = at(hinge_index(c));
        const double* w = &w_[at(start(c) + system_.links()[c].held)];
        next_point_[hinge] = path_step(*hinge_of(c), frozen_[hinge], point_[hinge], mu_, w);
        share_[hinge] = path_share(*hinge_of(c), point_[hinge], next_point_[hinge]);
        least = std::min(least, share_[hinge]);
    }
    double sum = 0;
    int parts = 0;
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!on_path_[c]) continue;
        const size_t hinge = at(hinge_index(c));
        point_[hinge] = along_path(*hinge_of(c), frozen_[hinge], point_[hinge], next_point_[hinge], together ? least : share_[hinge]);
        sum += path_gap(*hinge_of(c), point_[hinge]);
        parts += surfaces(*hinge_of(c));
    }
    return sum / parts;
}

// Rates at which the laws are linearised from here.
void Stepper::leave_path() {
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!on_path_[c]) continue;
        const size_t hinge = at(hinge_index(c));
        rates_of_path(*hinge_of(c), frozen_[hinge], point_[hinge], &w_[at(start(c) + system_.links()[c].held)]);
    }
    on_path_.assign(connections_.size(), 0);
}

bool Stepper::follow_path(bool together) {
    const double largest = enter_path(!together), end = path_end * largest;
    double best = INFINITY;
    bool arrived = false;
    for (int iteration = 0; iteration < (together ? path_limit_together : path_limit) && !arrived; iteration++) {
        double least;
        const double gap = step_on_path(together, least);
        if (!std::isfinite(gap) || gap > lost * best) break;
        best = std::min(best, gap);
        arrived = gap <= close_to_end * end && least > nearly_whole;
        if (kept_mu_ == 0 && gap <= path_kept * largest && least > half_way) {
            kept_point_ = point_;
            kept_mu_ = gap;
        }
        const double factor = least > half_way ? (together ? fast_together : fast) : least > some_way ? slow : 1;
        mu_ = std::max(end, factor * std::min(gap, largest));
    }
    leave_path();
    if (!arrived) kept_mu_ = 0;
    return arrived && descend(polish_limit, true);
}

}  // namespace crumple::spatial
