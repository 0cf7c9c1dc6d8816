// End velocities of a step: semismooth Newton method on the convex potential of stepper.hpp with all laws frozen.
#include <algorithm>
#include <cmath>

#include "common/pause.hpp"
#include "spatial/model/eigen.hpp"
#include "spatial/step/stepper.hpp"

namespace crumple::spatial {

namespace {

// Limits of full Newton steps, which fail only by cycling: before other methods, before the central path, later in the same step.
constexpr int full_step_limit = 32, full_step_limit_before_path = 12, full_step_limit_after_cycle = 8;
// Limit of Newton iterations for each width of the ramps before the time step is shortened: a fixed number and some per hinge, because
// in the worst case (an impulse on the end of a long chain) hinges lock and release one at a time.
constexpr int newton_limit = 60, newton_limit_per_hinge = 4;
constexpr double flat_enough = 0.1;  // slope of the potential at which a line search ends, over that at its start
constexpr double narrowing = 1e-1;  // factor between successive widths of the ramps, starting at the largest rate
// Relative tolerance of a law's impulse; piecewise linear laws reach rounding, curved ones converge to this.  With widened ramps
// the solution only has to show which hinges slide.
constexpr double impulse_tolerance = 1e-9, widened_tolerance = 1e-1;
constexpr double energy_rounding = 1e-14;  // energy that a Newton iteration could still change, over the kinetic energy: rounding
constexpr double no_energy = 1e-60;  // [J]: speeds that decay by friction would otherwise end below the smallest number
// Tolerance of the rates of held rows and of stiff laws relative to the speed; the rest is projected out at the end of the step.
constexpr double rate_tolerance = 1e-10;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

void Stepper::respond(size_t link, const double* w, double* impulse, double* tangent) const {
    const size_t index = at(connections_[link].index);
    if (is(link, Kind::contact)) return spatial::respond(contacts_.frozen(index), contacts_.rows(), w, impulse, tangent, nullptr);
    if (is(link, Kind::spring)) {
        impulse[0] = spring_force_[index] + spring_tangent_[index] * w[0];
        if (tangent) tangent[0] = spring_tangent_[index];
        return;
    }
    const size_t hinge = at(hinge_index(link));
    spatial::respond(model_.hinges[hinge], frozen_[hinge], w, impulse, tangent, nullptr);
}

// load factor of a hinge: above 1 it must flow
double Stepper::load(size_t link, const double* w) const {
    if (!is(link, Kind::joint)) return 0;
    const size_t hinge = at(hinge_index(link));
    return load_factor(model_.hinges[hinge], frozen_[hinge], w);
}

// Rates in a law: a w_0 + (1 - a) w for a coupled hinge that continues to slide, see `FrozenSpatialHinge::lead`.
void Stepper::seen_rate(size_t link, const double* w, double* seen) const {
    const int n = system_.links()[link].laws;
    const FrozenSpatialHinge* f = hinge_of(link) ? &frozen_[at(hinge_index(link))] : nullptr;
    const double lead = f ? f->lead : 0;
    for (int k = 0; k < n; k++) seen[k] = lead > 0 ? lead * f->w0[k] + (1 - lead) * w[k] : w[k];
}

// Multiplies the rates in a law (seen_rate).
void Stepper::scale_rate(size_t link, double factor, double* w) const {
    const int n = system_.links()[link].laws;
    double seen[most_components];
    seen_rate(link, w, seen);
    const FrozenSpatialHinge* f = hinge_of(link) ? &frozen_[at(hinge_index(link))] : nullptr;
    const double lead = f ? f->lead : 0;
    for (int k = 0; k < n; k++) w[k] = lead > 0 ? (factor * seen[k] - lead * f->w0[k]) / (1 - lead) : factor * w[k];
}

// Full Newton steps first, unless they cycled before in this step; then the central path; the globally convergent method last.
bool Stepper::newton() {
    tolerance_ = impulse_tolerance;
    energy_ = 0;
    for (size_t i = 0; i < free_.size(); i++) {
        energy_ += inertia() * (model_.bodies[i].mass * dot(free_[i].v, free_[i].v) + dot(free_[i].w, inertia_[i] * free_[i].w)) / 2;
    }
    const std::vector<Twist> velocity = velocity_;
    const std::vector<double> w = w_;
    // iterations that cycled may have moved far from the start
    auto restart = [&] {
        velocity_ = velocity;
        w_ = w;
    };
    // without inertia a locked hinge is so stiff that the rates that release it are lost in rounding: begin with wide ramps
    if (stage_.quasi_static) return narrow_ramps();
    if (!all_set_valued_) {
        if (descend(newton_steps(), false)) return true;
    } else if (!has_paths_ || contacts_.size() > 0) {
        if (descend(full_steps_ ? full_step_limit : full_step_limit_after_cycle, true)) return true;
        full_steps_ = false;
    } else {
        if (full_steps_ && descend(full_step_limit_before_path, true)) return true;
        full_steps_ = false;
        for (const bool together : {false, true}) {
            restart();
            if (follow_path(together)) return true;
        }
    }
    restart();
    return narrow_ramps();
}

int Stepper::newton_steps() const { return newton_limit + newton_limit_per_hinge * static_cast<int>(frozen_.size()); }

// A locked hinge is almost infinitely stiff, so a line search with the true ramps releases hinges one at a time.  The ramps are
// therefore widened and narrowed in stages (continuation), each solved with line search from the solution of the previous one.
bool Stepper::narrow_ramps() {
    double width = 1;
    for (size_t c = 0; c < connections_.size(); c++) {
        // the normal rate of a contact is not a slip
        const Link& link = system_.links()[c];
        for (int i = is(c, Kind::contact) ? 1 : 0; i < link.rows(); i++) width = std::max(width, std::fabs(w_[at(start(c) + i)]));
    }
    if (!std::isfinite(width)) return false;
    for (bool narrowest = false; !narrowest; width *= narrowing) {
        widen(width, narrowest);
        tolerance_ = narrowest ? impulse_tolerance : widened_tolerance;
        if (!descend(newton_steps(), false)) return false;
    }
    return true;
}

void Stepper::widen(double width, bool& narrowest) {
    narrowest = true;
    for (size_t i = 0; i < contacts_.size(); i++) {
        contacts_.widen(i, width);
        if (width > creep_rate && contacts_.ramps(i)) narrowest = false;
    }
    for (size_t c = 0; c < connections_.size(); c++) {
        if (!hinge_of(c)) continue;
        const SpatialHinge& hinge = *hinge_of(c);
        FrozenSpatialHinge& f = frozen_[at(hinge_index(c))];
        const double least = least_width(hinge), wanted = std::max(width, least);
        double* w = &w_[at(start(c) + system_.links()[c].held)];
        // within the ramp the moment is kept: the rate is reduced in proportion to the width
        if (wanted < f.width && load(c, w) < 1) scale_rate(c, wanted / f.width, w);
        spatial::widen(hinge, f, wanted);
        if (wanted > least) narrowest = false;
    }
}

// Linearisation of a law, or of its point on the central path, as impulse = offset + tangent w.
void Stepper::tangent_of(size_t link, double* offset, double* tangent) const {
    const Link& l = system_.links()[link];
    const int n = l.laws;
    const double* w = &w_[at(start(link) + l.held)];
    double impulse[most_components] = {}, slope[most_components * most_components] = {};
    std::fill(offset, offset + n, 0.0);
    std::fill(tangent, tangent + n * n, 0.0);
    if (on_path_[link]) {
        const size_t hinge = at(hinge_index(link));
        path_tangent(model_.hinges[hinge], frozen_[hinge], point_[hinge], mu_, offset, tangent);
        add_beside(model_.hinges[hinge], frozen_[hinge], w, impulse, slope, nullptr);
    } else {
        respond(link, w, impulse, slope);
    }
    for (int i = 0; i < n; i++) {
        offset[i] += impulse[i];
        for (int j = 0; j < n; j++) {
            offset[i] -= slope[i * n + j] * w[j];
            tangent[i * n + j] += slope[i * n + j];
        }
    }
}

// Stores the tangent D = Q d Q^T by its root Q sqrt(d), and the offset of the law.
void Stepper::linearise(size_t link) {
    const Link& l = system_.links()[link];
    const int n = l.laws, first = start(link) + l.held;
    Tangent& t = tangent_[link];
    double matrix[most_components * most_components];
    tangent_of(link, t.offset, matrix);
    eigenvectors(n, matrix, t.value, t.vectors);
    for (int k = 0; k < n; k++) {
        const double root = std::sqrt(std::max(t.value[k], 0.0));
        Row sum;
        for (int j = 0; j < n; j++) {
            const Row& row = rows_[at(first + j)];
            const double s = root * t.vectors[j * n + k];
            sum = {sum.t + s * row.t, sum.ma + s * row.ma, sum.mb + s * row.mb};
        }
        system_.row(first + k) = sum;
        t.value[k] = root;
    }
}

// Newton iterations, either with full steps (not guaranteed to converge) or with exact line search on the potential (descent).
bool Stepper::descend(int limit, bool full_steps) {
    for (int iteration = 0; iteration < limit && solves_ < last_solve_; iteration++) {
        solve_once();
        double slope = 0;
        const bool done = balanced(slope);
        if (!std::isfinite(slope)) return false;
        if (done) {
            velocity_.swap(next_);
            w_.swap(w_next_);
            return true;
        }
        if (full_steps) {
            take_full_step();
        } else if (iteration == 0 || slope <= 0) {
            // the first step is taken in full: it satisfies the held rows
            velocity_.swap(next_);
            w_.swap(w_next_);
        } else {
            const double a = search(slope);
            for (size_t i = 0; i < velocity_.size(); i++) velocity_[i] = velocity_[i] + a * (next_[i] - velocity_[i]);
            for (size_t k = 0; k < w_.size(); k++) w_[k] += a * (w_next_[k] - w_[k]);
        }
    }
    return false;
}

// solves for velocities, rates and impulses with the tangent of every law at w_
void Stepper::solve_once() {
    pause();
    const std::vector<Link>& links = system_.links();
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c);
        for (int i = 0; i < links[c].held; i++) system_.row(first + i) = rows_[at(first + i)];
        if (links[c].laws == 0) continue;
        linearise(c);
        for (int k = 0; k < links[c].laws; k++) impulse_[at(first + links[c].held + k)] = tangent_[c].offset[k];
    }
    next_ = free_;
    system_.push(rows_, impulse_.data(), true, next_.data());
    system_.factor();
    solves_++;
    system_.rates(next_.data(), x_.data());
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c), held = links[c].held, n = links[c].laws;
        for (int i = 0; i < held; i++) x_[at(first + i)] += bias_[at(first + i)] - target_[at(first + i)];
        const Tangent& t = tangent_[c];
        for (int k = 0; k < n; k++) {
            for (int j = 0; j < n; j++) x_[at(first + held + k)] += t.value[k] * t.vectors[j * n + k] * bias_[at(first + held + j)];
        }
    }
    system_.solve(x_.data(), rate_tolerance * speed_);
    system_.push(x_.data(), next_.data());
    // rates: in stiff directions from their own unknown, which preserves the digits of a locked hinge
    rates(rows_, next_.data(), w_next_.data());
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c), held = links[c].held, n = links[c].laws;
        for (int i = 0; i < held; i++) impulse_[at(first + i)] = x_[at(first + i)];
        if (n == 0) continue;
        const Tangent& t = tangent_[c];
        double* w = &w_next_[at(first + held)];
        double* p = &impulse_[at(first + held)];
        double along[most_components];
        for (int j = 0; j < n; j++) w[j] += bias_[at(first + held + j)];
        for (int k = 0; k < n; k++) {
            along[k] = 0;
            for (int j = 0; j < n; j++) along[k] += t.vectors[j * n + k] * w[j];
            const double y = x_[at(first + held + k)];
            if (system_.diagonal(first + held + k) > 1) along[k] = y / t.value[k];
            for (int j = 0; j < n; j++) p[j] += t.value[k] * t.vectors[j * n + k] * y;
        }
        for (int j = 0; j < n; j++) {
            w[j] = 0;
            for (int k = 0; k < n; k++) w[j] += t.vectors[j * n + k] * along[k];
        }
    }
}

// Whether the nonlinear impulses agree with their linearisation at the new rates; `slope`: of the potential along the step.
bool Stepper::balanced(double& slope) {
    const std::vector<Link>& links = system_.links();
    bool all = true;
    double moved = 0, furthest = 0;
    slope = 0;
    // friction at a contact with a small normal impulse is compared with the strongest contact
    double struck = 0;
    for (size_t i = 0; i < contacts_.size(); i++) struck = std::max(struck, -impulse_[contact_rows() + contacts_.rows() * i]);
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c) + links[c].held, n = links[c].laws;
        if (n == 0) continue;
        double p[most_components];
        respond(c, &w_next_[at(first)], p, nullptr);
        for (int k = 0; k < n; k++) {
            const double left = p[k] - impulse_[at(first + k)];
            double scale = std::fabs(p[k]);
            if (hinge_of(c)) scale += impulse_scale(*hinge_of(c), frozen_[at(hinge_index(c))], &w_next_[at(first)], k);
            if (is(c, Kind::contact)) scale += struck;
            if (!(std::fabs(left) <= tolerance_ * scale)) all = false;
            const double step = left * (w_next_[at(first + k)] - w_[at(first + k)]);
            if (std::fabs(step) > furthest) {
                furthest = std::fabs(step);
                stuck_body_ = links[c].body[links[c].body[1] >= 0 ? 1 : 0];
            }
            slope += step;
            moved += std::fabs(step);
        }
    }
    return all || moved <= energy_rounding * energy_ + no_energy;
}

// Whether a sliding hinge would reverse; if it continues and has a round surface, its next rates follow its impulse.
bool Stepper::reverses(size_t link) {
    const size_t first = at(start(link) + system_.links()[link].held);
    const SpatialHinge* hinge = hinge_of(link);
    if (hinge && round(*hinge)) return !follow_impulse(*hinge, frozen_[at(hinge_index(link))], &impulse_[first], &w_next_[first]);
    double along = 0, before[most_components], after[most_components];
    seen_rate(link, &w_[first], before);
    seen_rate(link, &w_next_[first], after);
    for (int k = 0; k < system_.links()[link].laws; k++) along += before[k] * after[k];
    return along < 0;
}

// Takes the full Newton step with two exceptions: a hinge that would reverse is set to zero rates first, and of neighbouring locked
// hinges that are overloaded only the one with the largest overload is released, because its release reduces the moments of its
// neighbours and most of them would lock again.
void Stepper::take_full_step() {
    const std::vector<Link>& links = system_.links();
    std::fill(overload_.begin(), overload_.end(), 0.0);
    std::fill(worst_near_.begin(), worst_near_.end(), 0.0);
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c) + links[c].held, n = links[c].laws;
        if (n == 0) continue;
        if (is(c, Kind::contact)) {
            stop_reversing(c);
            continue;
        }
        if (load(c, &w_[at(first)]) >= 1) {
            if (reverses(c)) scale_rate(c, 0, &w_next_[at(first)]);
            continue;
        }
        const double over = load(c, &w_next_[at(first)]);
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
        scale_rate(c, 0.999 / overload_[c], &w_next_[at(start(c) + links[c].held)]);
    }
    velocity_.swap(next_);
    w_.swap(w_next_);
}

// Line search: root in (0, 1) of the slope of the potential along next_ - velocity_; the slope is non-decreasing.
double Stepper::search(double slope_end) {
    const std::vector<Link>& links = system_.links();
    double curvature = 0, linear_end = 0;
    for (size_t i = 0; i < velocity_.size(); i++) {
        const Twist d = next_[i] - velocity_[i];
        curvature += inertia() * (model_.bodies[i].mass * dot(d.v, d.v) + dot(d.w, inertia_[i] * d.w));
    }
    for (size_t c = 0; c < links.size(); c++) {
        const int first = start(c) + links[c].held;
        for (int k = 0; k < links[c].laws; k++) {
            linear_end -= impulse_[at(first + k)] * (w_next_[at(first + k)] - w_[at(first + k)]);
        }
    }
    auto slope = [&](double a) {
        double f = linear_end - (1 - a) * curvature;
        for (size_t c = 0; c < links.size(); c++) {
            const int first = start(c) + links[c].held, n = links[c].laws;
            if (n == 0) continue;
            double w[most_components], p[most_components];
            for (int k = 0; k < n; k++) w[k] = w_[at(first + k)] + a * (w_next_[at(first + k)] - w_[at(first + k)]);
            respond(c, w, p, nullptr);
            for (int k = 0; k < n; k++) f += p[k] * (w_next_[at(first + k)] - w_[at(first + k)]);
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
