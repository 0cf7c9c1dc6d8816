// End velocities of a step by path following (interior-point method): for steps in which many hinges lock and slide at once.
//
// Every hinge has its own point on the path (central_hinge.hpp); the bodies' velocities are the solution of the problem linearised at
// these points.  Newton iterations continue while mu is reduced.  Each point moves towards its next one as far as it stays inside,
// independently of the others or, if that fails, all points by the same share.  The end of the path is the start for full Newton
// steps on the laws themselves, whose convergence alone decides whether the step is solved.
#include "spatial/solve/central_path.hpp"

#include <algorithm>
#include <cmath>

#include "spatial/solve/newton.hpp"

namespace crumple::spatial {

namespace {

// mu at the start of a path, at the point kept for the following passes, and at the end, relative to the largest rate.
constexpr double path_begin = 1e-1, path_kept = 1e-6, path_end = 1e-11;
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

CentralPath::CentralPath(Problem& problem) : p_(problem) {
    const auto rigid = [](const SpatialHinge& hinge) { return hinge.components.front().law.form == Form::set_valued; };
    const auto folds = [](const SpatialHinge& hinge) { return hinge.surface.coupling == Coupling::tension_flange; };
    const std::vector<SpatialHinge>& hinges = p_.model.hinges;
    exists_ = std::any_of(hinges.begin(), hinges.end(), rigid);
    for (const SpatialHinge& hinge : hinges) exists_ = exists_ && !(rigid(hinge) && folds(hinge));
}

void CentralPath::linearise(size_t link, const double* w, double* impulse, double* slope, double* offset, double* tangent) {
    const size_t hinge = at(p_.hinge_index(link));
    tangent_[hinge] = path_tangent(p_.model.hinges[hinge], p_.frozen[hinge], point_[hinge], mu_, offset, tangent);
    add_beside(p_.model.hinges[hinge], p_.frozen[hinge], w, impulse, slope, nullptr);
}

// Start points: those kept from the last path of this step, or from the moments of the last step and the guessed rates.  Returns the
// largest rate, which before an impact is that of closing contacts, because no hinge turns yet.
double CentralPath::enter(bool warm) {
    double largest = 0;
    on_.assign(p_.connections.size(), 0);
    point_.resize(p_.frozen.size());
    tangent_.resize(p_.frozen.size());
    for (size_t c = 0; c < p_.connections.size(); c++) {
        const double* w = &p_.w[at(p_.start(c) + p_.system.links()[c].held)];
        if (p_.is_contact(c)) largest = std::max(largest, -w[0] / p_.model.length);
        if (!p_.hinge_of(c) || !has_path(*p_.hinge_of(c), p_.frozen[at(p_.hinge_index(c))])) continue;
        on_[c] = 1;
        for (int k = 0; k < p_.system.links()[c].laws; k++) largest = std::max(largest, std::fabs(w[k]));
    }
    warm = warm && kept_mu_ > 0;
    mu_ = warm ? kept_mu_ : path_begin * largest;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!on_[c]) continue;
        const size_t hinge = at(p_.hinge_index(c));
        const FrozenSpatialHinge& f = p_.frozen[hinge];
        double impulse[most_components];
        for (int k = 0; k < size(*p_.hinge_of(c)); k++) impulse[k] = f.h * f.tau0[k];
        point_[hinge] = warm ? kept_point_[hinge] : near_path(*p_.hinge_of(c), f, impulse, &p_.w[at(p_.start(c) + p_.system.links()[c].held)], mu_);
    }
    kept_mu_ = 0;
    return largest;
}

// One Newton iteration; returns the mean of s (1 - g^2), and in `least` the smallest share of its step that a point took.
double CentralPath::step(NewtonSolver& newton, bool together, double& least) {
    newton.solve_once();
    newton.take();
    next_point_.resize(point_.size());
    share_.assign(point_.size(), 1.0);
    least = 1;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!on_[c]) continue;
        const size_t hinge = at(p_.hinge_index(c));
        const double* w = &p_.w[at(p_.start(c) + p_.system.links()[c].held)];
        next_point_[hinge] = path_step(*p_.hinge_of(c), p_.frozen[hinge], point_[hinge], tangent_[hinge], mu_, w);
        share_[hinge] = path_share(*p_.hinge_of(c), point_[hinge], next_point_[hinge]);
        least = std::min(least, share_[hinge]);
    }
    double sum = 0;
    int parts = 0;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!on_[c]) continue;
        const size_t hinge = at(p_.hinge_index(c));
        point_[hinge] = along_path(*p_.hinge_of(c), p_.frozen[hinge], point_[hinge], next_point_[hinge], together ? least : share_[hinge]);
        sum += path_gap(*p_.hinge_of(c), point_[hinge]);
        parts += surfaces(*p_.hinge_of(c));
    }
    return sum / parts;
}

// Sets the rates at which the laws themselves are linearised after the path.
void CentralPath::leave() {
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!on_[c]) continue;
        const size_t hinge = at(p_.hinge_index(c));
        rates_of_path(*p_.hinge_of(c), p_.frozen[hinge], point_[hinge], &p_.w[at(p_.start(c) + p_.system.links()[c].held)]);
    }
    on_.assign(p_.connections.size(), 0);
}

bool CentralPath::follow(NewtonSolver& newton, bool together) {
    const double largest = enter(!together), end = path_end * largest;
    double best = INFINITY;
    bool arrived = false;
    for (int iteration = 0; iteration < (together ? path_limit_together : path_limit) && !arrived; iteration++) {
        double least;
        const double gap = step(newton, together, least);
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
    leave();
    if (!arrived) kept_mu_ = 0;
    return arrived && newton.descend(polish_limit, true);
}

}  // namespace crumple::spatial
