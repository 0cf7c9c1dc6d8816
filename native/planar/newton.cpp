// Joint rates at the end of a step: semismooth Newton method on the convex potential of stepper.hpp, with all non-convex
// quantities of bodies and hinges frozen.
#include <algorithm>
#include <cmath>

#include "common/pause.hpp"
#include "planar/dense.hpp"
#include "planar/stepper.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

namespace {

// Limit of full Newton steps before the globally convergent method is used; they fail only by cycling, which is rare.  In a chain
// hinges start to flow one after another, so the limit grows by one for every `hinges_per_full_step` hinges.
constexpr int full_step_limit = 16, hinges_per_full_step = 8;
// Limit of Newton iterations for each width of the ramps before the time step is shortened: a fixed number and some per hinge,
// because in the worst case (an impulse on the end of a long chain) hinges lock and release one at a time.
constexpr int newton_limit = 60, newton_limit_per_hinge = 4;
// Factor by which the widened ramps are narrowed from one solution to the next, starting at the largest rate.
constexpr double narrowing = 1e-1;
// Relative tolerance of a hinge's impulse; piecewise linear laws reach round-off, HAVSIN ramps converge to this.
constexpr double impulse_tolerance = 1e-9;

}  // namespace

// A locked hinge is almost infinitely stiff, so a line search with the true ramps releases hinges one at a time.  Full steps are
// therefore tried first if all hinges are set-valued; if they cycle, the ramps are widened and then narrowed in stages (continuation),
// each stage solved with line search from the solution of the previous one.
bool Stepper::newton() {
    std::fill(impedance_.begin(), impedance_.end(), 0.0);
    std::fill(rhs_.begin(), rhs_.end(), 0.0);
    const int limit = newton_limit + newton_limit_per_hinge * static_cast<int>(frozen_.size());
    if (all_set_valued_ ? descend(full_step_limit + static_cast<int>(frozen_.size()) / hinges_per_full_step, true) : descend(limit, false)) return true;
    Real width = 1;
    for (const Real& w : w_) width = max(width, fabs(w));
    if (!std::isfinite(value(width))) return false;
    for (bool narrowest = false; !narrowest; width *= narrowing) {
        narrowest = true;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const Hinge& hinge = model_.hinges[j];
            const Real wanted = max(width, ramp_width(hinge));
            Real& w = w_[static_cast<size_t>(hinge.dof)];
            // within the ramp the moment is kept: the rate is reduced in proportion to the width
            if (wanted < frozen_[j].width && fabs(w) < frozen_[j].width) w *= wanted / frozen_[j].width;
            frozen_[j].width = wanted;
            if (wanted > ramp_width(hinge)) narrowest = false;
        }
        if (!descend(limit, false)) return false;
    }
    return true;
}

// Takes the full Newton step with two exceptions: a hinge that would reverse its rotation is set to zero rate first, and of
// neighbouring locked hinges that are overloaded only the one with the largest overload is released, because its release reduces
// the moments of its neighbours and most of them would lock again.
void Stepper::take_full_step() {
    std::fill(overload_.begin(), overload_.end(), 0.0);
    std::fill(overload_of_children_.begin(), overload_of_children_.end(), 0.0);
    for (size_t j = 0; j < frozen_.size(); j++) {
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        const Real width = frozen_[j].width;
        const bool locked = fabs(w_[dof]) < width;
        if (!locked && next_[dof] * w_[dof] < 0) next_[dof] = 0;
        if (locked && fabs(next_[dof]) > width) overload_[dof] = fabs(next_[dof]) / width;
    }
    const Tree& tree = model_.tree;
    for (int i = 0; i < tree.bodies(); i++) {
        if (tree[i].parent < 0) continue;
        Real& most = overload_of_children_[static_cast<size_t>(tree[tree[i].parent].dof)];
        most = max(most, overload_[static_cast<size_t>(tree[i].dof)]);
    }
    for (int i = 0; i < tree.bodies(); i++) {
        const auto dof = static_cast<size_t>(tree[i].dof);
        const Real own = overload_[dof];
        if (own == 0) continue;
        const Real above = tree[i].parent < 0 ? 0 : overload_[static_cast<size_t>(tree[tree[i].parent].dof)];
        if (own < above || own < overload_of_children_[dof]) next_[dof] *= 0.999 / own;
    }
    w_.swap(next_);
}

// Newton iterations, either with full steps (not guaranteed to converge) or with exact line search on the potential (descent in
// every iteration).
bool Stepper::descend(int limit, bool full_steps) {
    for (int iteration = 0; iteration < limit; iteration++) {
        linearise();
        solve_once();
        // residuals of the nonlinear responses at the new rates, and the slope of the potential along the step
        Real slope = 0;
        bool balanced = true;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const auto dof = static_cast<size_t>(model_.hinges[j].dof);
            const Real w = next_[dof], tangent = impedance_[dof] * w - rhs_[dof];
            const Real impulse = respond(model_.hinges[j], frozen_[j], w).impulse, left = impulse - tangent;
            const Real scale = frozen_[j].h * (frozen_[j].capacity[0] + frozen_[j].capacity[1]) + fabs(impulse);
            if (!(fabs(left) <= impulse_tolerance * scale)) balanced = false;
            slope += left * (w - w_[dof]);
        }
        if (!std::isfinite(value(slope))) return false;
        if (balanced) {
            w_.swap(next_);
            return true;
        }
        if (full_steps) {
            take_full_step();
        } else if (slope <= 0) {
            w_.swap(next_);
        } else {
            const Real a = search(slope);
            for (size_t k = 0; k < w_.size(); k++) w_[k] += a * (next_[k] - w_[k]);
        }
    }
    return false;
}

// Tangent of every hinge at the present rates, as impedance and right-hand side.
void Stepper::linearise() {
    for (size_t j = 0; j < frozen_.size(); j++) {
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        const Response r = respond(model_.hinges[j], frozen_[j], w_[dof]);
        impedance_[dof] = r.slope;
        rhs_[dof] = r.slope * w_[dof] - r.impulse;
    }
}

// Derivatives of the solution by the implicit function theorem: with the solved rates held constant, the derivatives of the linear
// problem are those of the equilibrium, because its tangents are exact at the solution.
void Stepper::differentiate() {
    for (Real& w : w_) w = value(w);
    linearise();
    solve_once();
    for (size_t k = 0; k < w_.size(); k++) take_directions(w_[k], next_[k]);
}

void Stepper::solve_once() {
    pause();
    work_ = bias_;
    solver_.solve(impedance_.data(), work_.data(), rhs_.data(), next_.data());
    solves_++;
    if (!rows_.empty()) constrain(next_.data(), 0);
}

// Adds to w the response to the constraint impulses that bring the constrained directions, from row `first` on, to their target
// rates.
void Stepper::constrain(Real* w, size_t first) {
    const size_t n = rows_.size() - first, m = w_.size();
    auto rates = [&](const Real* rate, Real* out) {
        model_.tree.twists(middle_.data(), rate, twist_.data());
        for (size_t k = 0; k < n; k++) out[k] = row_rate(rows_[first + k], middle_.data(), twist_.data());
    };
    for (size_t k = 0; k < n; k++) {
        const Row& row = rows_[first + k];
        std::fill(work_.begin(), work_.end(), Twist{});
        auto push = [&](int body, Vec2 point, Real sign) {
            const Vec2 a = arm(body, point, middle_.data());
            const Real moment = row.direction.w + cross(a, row.direction.v);
            work_[static_cast<size_t>(body)] = {sign * moment, sign * row.direction.v};
        };
        push(row.body, row.point, 1);
        if (row.other >= 0) push(row.other, row.other_point, -1);
        solver_.solve_again(work_.data(), zero_.data(), &row_rates_[k * m]);
        rates(&row_rates_[k * m], &row_matrix_[k * n]);
    }
    rates(w, row_force_.data());
    for (size_t k = 0; k < n; k++) row_force_[k] = row_target_[first + k] - row_force_[k];
    solve_symmetric(row_matrix_.data(), row_force_.data(), static_cast<int>(n));
    for (size_t k = 0; k < n; k++) {
        for (size_t i = 0; i < m; i++) w[i] += row_force_[k] * row_rates_[k * m + i];
    }
}

// Line search: root in (0, 1) of the slope of the potential along next - w.  It is exact for piecewise linear responses, because
// the bracket is reduced to one piece before interpolation.
Real Stepper::search(Real slope_end) {
    Real curvature = 0, linear_end = 0;
    for (size_t k = 0; k < w_.size(); k++) direction_[k] = next_[k] - w_[k];
    model_.tree.twists(middle_.data(), direction_.data(), twist_.data());
    model_.tree.to_centres(middle_.data(), twist_.data());
    for (int i = 0; i < model_.tree.bodies(); i++) {
        const Twist& v = twist_[static_cast<size_t>(i)];
        curvature += model_.tree[i].mass * dot(v.v, v.v) + model_.tree[i].inertia * v.w * v.w;
    }
    breakpoints_.clear();
    for (size_t j = 0; j < frozen_.size(); j++) {
        const auto dof = static_cast<size_t>(model_.hinges[j].dof);
        const Real d = direction_[dof];
        linear_end += (rhs_[dof] - impedance_[dof] * next_[dof]) * d;
        Real rates[10];
        const int n = kinks(model_.hinges[j], frozen_[j], rates);
        for (int k = 0; k < n; k++) {
            const Real a = (rates[k] - w_[dof]) / d;
            if (a > 0 && a < 1) breakpoints_.push_back(a);
        }
    }
    auto slope = [&](Real a) {
        Real f = linear_end - (1 - a) * curvature;
        for (size_t j = 0; j < frozen_.size(); j++) {
            const auto dof = static_cast<size_t>(model_.hinges[j].dof);
            const Real w = w_[dof] + a * direction_[dof];
            f += respond(model_.hinges[j], frozen_[j], w).impulse * direction_[dof];
        }
        return f;
    };
    std::sort(breakpoints_.begin(), breakpoints_.end());
    Real lo = 0, hi = 1, f_lo = slope(0), f_hi = slope_end;
    size_t first = 0, last = breakpoints_.size();
    while (first < last) {
        const size_t middle = (first + last) / 2;
        const Real a = breakpoints_[middle], f = slope(a);
        if (f > 0) {
            hi = a;
            f_hi = f;
            last = middle;
        } else {
            lo = a;
            f_lo = f;
            first = middle + 1;
        }
    }
    // within one piece: secant method, with bisection in every third iteration in case the piece is curved
    for (int k = 0; k < 40 && hi - lo > 1e-15 * hi; k++) {
        const Real a = k % 3 == 2 ? (lo + hi) / 2 : lo - f_lo * (hi - lo) / (f_hi - f_lo);
        if (!(a > lo && a < hi)) break;
        const Real f = slope(a);
        if (fabs(f) <= 1e-12 * fabs(slope_end)) return a;
        (f > 0 ? hi : lo) = a;
        (f > 0 ? f_hi : f_lo) = f;
    }
    return f_lo < -f_hi && f_hi < -f_lo ? hi : (-f_lo < f_hi && lo > 0 ? lo : hi);
}

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
