// End velocities of a step by path following (interior-point method): for steps in which many hinges lock and slide at once.
//
// Every hinge has its own point on the path (central_hinge.hpp); the bodies' velocities are the solution of the problem linearised at
// these points.  Newton iterations continue while mu is reduced.  Each point moves towards its next one as far as it stays inside,
// independently of the others or, if that fails, all points by the same share.  The end of the path is the start for full Newton
// steps on the laws themselves, whose convergence alone decides whether the step is solved.
#include <algorithm>
#include <cmath>

#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// mu at the start of a path, at the point kept for the following passes, and at the end, relative to the largest rate.
constexpr double path_begin = 1e-1, path_kept = 1e-4, path_end = 1e-11;
// At the end the mean s (1 - g^2) is within this factor of the final mu, and all points took at least this share of their last step.
constexpr double close_to_end = 2, nearly_whole = 0.7;
// Reduction of mu if all points took half of their step: independently (`fast`), by the same share (`fast_together`); and if they took
// a tenth of it (`slow`).
constexpr double fast = 0.03, fast_together = 0.1, slow = 0.3;
constexpr double half_way = 0.5, some_way = 0.1;
// Limits of the Newton iterations with independent and with common shares; and growth of the mean s (1 - g^2) that shows divergence.
constexpr int path_limit = 16, path_limit_together = 60;
constexpr double lost = 10;
// limit of full Newton steps on the laws from the end of the path
constexpr int polish_limit = 12;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

// Start points: those kept from the last path of this step, or from the moments of the last step and the guessed rates.  Returns the
// largest rate.
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

// One Newton iteration; returns the mean of s (1 - g^2), and in `least` the smallest share of its step that a point took.
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

// Sets the rates at which the laws themselves are linearised after the path.
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
