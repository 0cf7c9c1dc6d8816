#include "spatial/solve/newton.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

// Limits of full Newton steps, which fail only by cycling: before other methods, before the central path without and with contacts, after a
// pass in which they cycled.
constexpr int full_step_limit = 32, full_step_limit_before_path = 12, full_step_limit_with_contacts = 16, full_step_limit_after_cycle = 8;
// Passes in a row in which they cycled, after which they are tried before the central path in one of so many passes only.
constexpr int most_cycled = 4, passes_between = 16;
// Limit of Newton iterations for each width of the ramps before the time step is shortened: a fixed number and some per hinge, because
// in the worst case (an impulse on the end of a long chain) hinges lock and release one at a time.
constexpr int newton_limit = 60, newton_limit_per_hinge = 4;
// Newton steps that are taken as they are found before line searches begin, with ramps of their own width: a line search leads to one
// kink of friction and yielding after the other, which such steps pass at once.
constexpr int first_found_steps = 5;
constexpr double flat_enough = 0.1;  // slope of the potential at which a line search ends, over that at its start
constexpr double narrowing = 1e-1;  // factor between successive widths of the ramps, starting at the largest rate
// Relative tolerance of a law's impulse; piecewise linear laws reach rounding, curved ones converge to this.  Where vibration is passed
// over, moments are known to far fewer digits, and a quarter of the solves brings none.  With widened ramps the solution only has to show
// which hinges slide.
constexpr double impulse_tolerance = 1e-9, vibrating_tolerance = 1e-6, widened_tolerance = 1e-1;
// Limit of the linear solves of a step relative to the Newton iterations allowed for one width of the ramps: enough for all widths in
// two passes, and some more.
constexpr int most_solves = 20;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

NewtonSolver::NewtonSolver(Problem& problem) : p_(problem), path_(problem) {
    next_.resize(p_.model.bodies.size());
    worst_near_.assign(p_.model.bodies.size(), 0.0);
    relinked();
}

void NewtonSolver::relinked() {
    overload_.assign(p_.connections.size(), 0.0);
    evaluated_.resize(p_.connections.size());
    path_.relinked();
    solved_ = false;
}

void NewtonSolver::begin(bool warm, bool rubs) {
    rubs_ = rubs;
    presses_ = true;
    last_solve_ = solves_ + most_solves * most_iterations();
    if (!warm) {
        path_.forget();
        if (!path_.exists()) cycled_ = 0;
    }
    solved_ = solved_ && warm;
}

void NewtonSolver::start_from(const std::vector<double>& rates) {
    path_.forget();
    solved_ = rates.size() == p_.w.size();
    if (solved_) p_.w = rates;
}

// Newton's method starts from the guess, but hinges that were locked in the last pass start with the rates of that pass: these are far
// below the accuracy of a guess and give the hinges' shares of their capacity.  The laws are frozen with the guess alone.
void NewtonSolver::keep_locked() {
    for (size_t c = 0; solved_ && c < p_.connections.size(); c++) {
        const size_t first = at(p_.start(c) + p_.system.links()[c].held);
        if (!p_.hinge_of(c) || p_.load(c, &p_.w_next[first]) >= 1) continue;
        std::copy_n(&p_.w_next[first], p_.system.links()[c].laws, &p_.w[first]);
    }
}

bool NewtonSolver::solve() {
    forget_laws();
    solved_ = solve_laws();
    return solved_;
}

void NewtonSolver::take() {
    p_.velocity.swap(next_);
    p_.w.swap(p_.w_next);
}

// Limit of full Newton steps before the next method.  Where they cycle before a central path, they mostly do in the passes that follow too, of
// other steps as well.
int NewtonSolver::most_full_steps(bool path) const {
    if (!path && !p_.all_set_valued) return most_iterations();
    if (path && cycled_ >= most_cycled && left_out_ + 1 < passes_between) return 0;
    if (cycled_ > 0) return full_step_limit_after_cycle;
    if (!path) return full_step_limit;
    return p_.contacts.size() > 0 ? full_step_limit_with_contacts : full_step_limit_before_path;
}

// Full Newton steps first (with line search if some hinges are not rigid), unless they cycled before; then the central path; the globally
// convergent method last.
bool NewtonSolver::solve_laws() {
    tolerance_ = finest_tolerance();
    energy_ = 0;
    followed_ = 0;
    in_turns_ = false;
    for (size_t i = 0; i < p_.free.size(); i++) {
        energy_ += p_.inertia_share() * (p_.model.bodies[i].mass * dot(p_.free[i].v, p_.free[i].v) + dot(p_.free[i].w, p_.inertia[i] * p_.free[i].w)) / 2;
    }
    const std::vector<Twist> velocity = p_.velocity;
    const std::vector<double> w = p_.w;
    // iterations that cycled may have moved far from the start
    auto restart = [&] {
        p_.velocity = velocity;
        p_.w = w;
    };
    // without inertia a locked hinge is so stiff that the rates that release it are lost in rounding: begin with wide ramps
    if (p_.stage.quasi_static) return narrow_ramps();
    const bool follows = path_.exists() && (p_.contacts.size() == 0 || p_.all_set_valued);
    const int limit = most_full_steps(follows);
    const bool solved = descend(limit, p_.all_set_valued, follows ? 0 : first_found_steps);
    // what is only looked at between steps changes nothing for those that follow
    if (rubs_) {
        cycled_ = solved ? 0 : cycled_ + (limit > 0);
        left_out_ = limit > 0 ? 0 : left_out_ + 1;
    }
    if (solved) return true;
    if (follows) {
        for (const bool together : {false, true}) {
            restart();
            if (path_.follow(*this, together)) return true;
        }
    }
    restart();
    return narrow_ramps();
}

double NewtonSolver::finest_tolerance() const {
    const bool passes_over = p_.elastic && std::isfinite(p_.model.resolved_frequency) && !p_.stage.quasi_static;
    return passes_over ? vibrating_tolerance : impulse_tolerance;
}

int NewtonSolver::most_iterations() const { return newton_limit + newton_limit_per_hinge * static_cast<int>(p_.frozen.size()); }

// A locked hinge is almost infinitely stiff, so a line search with the true ramps releases hinges one at a time.  The ramps are
// therefore widened and narrowed in stages (continuation), each solved with line search from the solution of the previous one.
bool NewtonSolver::narrow_ramps() {
    double width = 1;
    for (size_t c = 0; c < p_.connections.size(); c++) {
        // the normal rate of a contact is not a slip
        const Link& link = p_.system.links()[c];
        for (int i = p_.is_contact(c) ? 1 : 0; i < link.rows(); i++) width = std::max(width, std::fabs(p_.w[at(p_.start(c) + i)]));
    }
    if (!std::isfinite(width)) return false;
    for (bool narrowest = false; !narrowest; width *= narrowing) {
        widen(width, narrowest);
        tolerance_ = narrowest ? finest_tolerance() : widened_tolerance;
        if (!descend(most_iterations(), false)) return false;
    }
    return true;
}

void NewtonSolver::widen(double width, bool& narrowest) {
    narrowest = true;
    forget_laws();
    for (size_t i = 0; i < p_.contacts.size(); i++) {
        p_.contacts.widen(i, width);
        if (width > creep_rate && p_.contacts.ramps(i)) narrowest = false;
    }
    for (size_t c = 0; c < p_.connections.size(); c++) {
        if (!p_.hinge_of(c)) continue;
        const SpatialHinge& hinge = *p_.hinge_of(c);
        FrozenSpatialHinge& f = p_.frozen[at(p_.hinge_index(c))];
        const double least = p_.least_width(hinge), wanted = std::max(width, least);
        double* w = &p_.w[at(p_.start(c) + p_.system.links()[c].held)];
        // within the ramp the moment is kept: the rate is reduced in proportion to the width
        if (wanted < f.width && p_.load(c, w) < 1) p_.scale_rate(c, wanted / f.width, w);
        spatial::widen(hinge, f, wanted);
        if (wanted > least) narrowest = false;
    }
}

// Newton iterations, either with full steps (not guaranteed to converge) or with exact line search on the potential (descent) after a
// number of steps that are taken as they are found.
bool NewtonSolver::descend(int limit, bool full_steps, int found) {
    for (int iteration = 0; iteration < limit && solves_ < last_solve_; iteration++) {
        solve_once();
        double slope = 0;
        const bool done = settled(slope);
        if (!std::isfinite(slope)) return false;
        if (done) {
            take();
            return true;
        }
        if (full_steps) {
            take_full_step();
        } else if (iteration < found) {
            for (size_t i = 0; i < p_.contacts.size(); i++) stop_reversing(contact_link(i));
            take();
        } else if (iteration == 0 || slope <= 0) {
            // the first step is taken in full: it satisfies the held rows
            take();
        } else {
            const double a = search(slope);
            for (size_t i = 0; i < p_.velocity.size(); i++) p_.velocity[i] = p_.velocity[i] + a * (next_[i] - p_.velocity[i]);
            for (size_t k = 0; k < p_.w.size(); k++) p_.w[k] += a * (p_.w_next[k] - p_.w[k]);
        }
    }
    return false;
}

// Whether impulses agree with their laws, and friction with normal impulses, which it follows first; `slope` as in `balanced`.
bool NewtonSolver::settled(double& slope) {
    if (!balanced(slope)) return false;
    if (!rubs_ || tolerance_ > finest_tolerance() || p_.contacts.rows() == 1 || p_.contacts.size() == 0) return true;
    return friction_holds(slope);
}

// Whether a sliding hinge would reverse; if it continues and has a round surface, its next rates follow its impulse.
bool NewtonSolver::reverses(size_t link) {
    const size_t first = at(p_.start(link) + p_.system.links()[link].held);
    const SpatialHinge* hinge = p_.hinge_of(link);
    if (hinge && round(*hinge)) return !follow_impulse(*hinge, p_.frozen[at(p_.hinge_index(link))], &p_.impulse[first], &p_.w_next[first]);
    double along = 0, before[most_components], after[most_components];
    p_.seen_rate(link, &p_.w[first], before);
    p_.seen_rate(link, &p_.w_next[first], after);
    for (int k = 0; k < p_.system.links()[link].laws; k++) along += before[k] * after[k];
    return along < 0;
}

// Sets the tangential rates of a contact that would reverse its slip to zero first.
void NewtonSolver::stop_reversing(size_t link) {
    const double *w = &p_.w[at(p_.start(link))], width = p_.contacts.frozen(at(p_.connections[link].index)).width;
    double* next = &p_.w_next[at(p_.start(link))];
    if (p_.contacts.rows() == 3 && std::hypot(w[1], w[2]) > width && w[1] * next[1] + w[2] * next[2] < 0) next[1] = next[2] = 0;
}

// Takes the full Newton step with two exceptions: a hinge that would reverse is set to zero rates first, and of neighbouring locked
// hinges that are overloaded only the one with the largest overload is released, because its release reduces the moments of its
// neighbours and most of them would lock again.
void NewtonSolver::take_full_step() {
    const std::vector<Link>& links = p_.system.links();
    std::fill(overload_.begin(), overload_.end(), 0.0);
    std::fill(worst_near_.begin(), worst_near_.end(), 0.0);
    for (size_t c = 0; c < links.size(); c++) {
        const int first = p_.start(c) + links[c].held, n = links[c].laws;
        if (n == 0) continue;
        if (p_.is_contact(c)) {
            stop_reversing(c);
            continue;
        }
        if (p_.load(c, &p_.w[at(first)]) >= 1) {
            if (reverses(c)) p_.scale_rate(c, 0, &p_.w_next[at(first)]);
            continue;
        }
        const double over = p_.load(c, &p_.w_next[at(first)]);
        if (over <= 1) continue;
        overload_[c] = over;
        for (const int body : links[c].body) {
            if (body >= 0) worst_near_[at(body)] = std::max(worst_near_[at(body)], over);
        }
    }
    for (size_t c = 0; c < links.size(); c++) {
        if (overload_[c] == 0) continue;
        bool largest = true;
        for (const int body : links[c].body) largest = largest && (body < 0 || overload_[c] >= worst_near_[at(body)]);
        if (largest) continue;
        p_.scale_rate(c, 0.999 / overload_[c], &p_.w_next[at(p_.start(c) + links[c].held)]);
    }
    take();
}

// Line search: root in (0, 1) of the slope of the potential along next_ - p_.velocity; the slope is non-decreasing.
double NewtonSolver::search(double slope_end) {
    const std::vector<Link>& links = p_.system.links();
    double curvature = 0, linear_end = 0;
    for (size_t i = 0; i < p_.velocity.size(); i++) {
        const Twist d = next_[i] - p_.velocity[i];
        curvature += p_.inertia_share() * (p_.model.bodies[i].mass * dot(d.v, d.v) + dot(d.w, p_.inertia[i] * d.w));
    }
    for (size_t c = 0; c < links.size(); c++) {
        const int first = p_.start(c) + links[c].held;
        for (int k = 0; k < links[c].laws; k++) {
            linear_end -= p_.impulse[at(first + k)] * (p_.w_next[at(first + k)] - p_.w[at(first + k)]);
        }
    }
    auto slope = [&](double a) {
        double f = linear_end - (1 - a) * curvature;
        for (size_t c = 0; c < links.size(); c++) {
            const int first = p_.start(c) + links[c].held, n = links[c].laws;
            if (n == 0) continue;
            double w[most_components], p[most_components];
            for (int k = 0; k < n; k++) w[k] = p_.w[at(first + k)] + a * (p_.w_next[at(first + k)] - p_.w[at(first + k)]);
            p_.respond(c, w, p, nullptr);
            for (int k = 0; k < n; k++) f += p[k] * (p_.w_next[at(first + k)] - p_.w[at(first + k)]);
        }
        return f;
    };
    const double f_start = slope(0);
    double lo = 0, hi = 1, f_lo = f_start, f_hi = slope_end;
    if (!(f_lo < 0)) return 1;  // not a descent direction by rounding
    // secant method with halved weights (Illinois), bisection every third time because ramps of locked hinges are narrow
    int side = 0;
    for (int k = 0; k < 60 && hi - lo > 1e-14 * hi; k++) {
        double a = k % 3 == 2 ? (lo + hi) / 2 : lo - f_lo * (hi - lo) / (f_hi - f_lo);
        if (!(a > lo && a < hi)) a = (lo + hi) / 2;
        const double f = slope(a);
        if (std::fabs(f) <= flat_enough * std::fabs(f_start)) return a;
        if (f > 0) {
            hi = a;
            f_hi = f;
            if (side == 1) f_lo /= 2;
            side = 1;
        } else {
            lo = a;
            f_lo = f;
            if (side == -1) f_hi /= 2;
            side = -1;
        }
    }
    return hi;
}

}  // namespace crumple::spatial
