// Von Mises plasticity in plane stress: implicit return mapping, iterated to round-off.
//
// With p = sx + sy, d = sx - sy of the elastic trial and the unknown X = 3 G dep / Y(end of step), the
// stress at the end is p / (1 + R X), d / (1 + X), sxy / (1 + X), R = (1 + nu) / (3 (1 - nu)), and
// X follows from one equation
//     q(X) (1 - H X / 3G) = Y0,    q^2 = p^2/4 u^2 + (3/4 d^2 + 3 sxy^2) v^2,   u = 1/(1 + R X), v = 1/(1 + X),
// with H the slope of the present hardening segment and Y0 its value at the old plastic strain.  1/q is nearly
// linear in X, so Newton's method on 1/q needs two iterations in an ordinary time step.  Every lane stops by its own
// residual, and lanes that do not yield keep their trial stress: the result of an element does not depend on
// its neighbours in the block.  Theory: docs/theory/plasticity.md.
#pragma once
#include "shell/simd/pack.hpp"
#include "shell/element/part.hpp"

namespace crumple::shell {
namespace {

// Relative residual below which one more Newton iteration, with its quadratic convergence, reaches round-off.
constexpr double last_step_residual = 1e-7;
// Limit of the iterations, reached only by tables with convex kinks; ordinary steps need two.
constexpr int max_return_steps = 40;

struct Stress {
    Real x, y, xy;
};
// hardening segment at the plastic strain `at`: its value extrapolated to `start`, and its slope
struct YieldLine {
    Real value, slope;
};

CRUMPLE_INLINE YieldLine yield_line(const Part& part, Real start, Real at, Real factor) {
    const double *e = part.table_strain, *s = part.table_stress;
    YieldLine line{all(s[0]), Real{}};
    double least = e[part.table_size - 1], largest = e[0];
    for (int i = 0; i < lanes; i++) {
        least = at[i] < least ? at[i] : least;
        largest = at[i] > largest ? at[i] : largest;
    }
    // only the segments from that of the least strain to that of the largest one: tables have 80
    int first = 0;
    for (int beyond = part.table_size; beyond - first > 1;) {
        const int middle = (first + beyond) / 2;
        (e[middle] <= least ? first : beyond) = middle;
    }
    for (int i = first; i + 1 < part.table_size && e[i] <= largest; i++) {
        const double slope = (s[i + 1] - s[i]) / (e[i + 1] - e[i]);
        const Mask here = at >= e[i];
        line.value = here ? s[i] + slope * (start - e[i]) : line.value;
        line.slope = here ? all(slope) : line.slope;
    }
    // beyond the last point the yield stress is constant
    const Mask beyond = at >= e[part.table_size - 1];
    line.value = beyond ? all(s[part.table_size - 1]) : line.value;
    line.slope = beyond ? Real{} : line.slope;
    return {line.value * factor, line.slope * factor};
}

// Cowper-Symonds 1 + (rate / D)^(1/q) or Johnson-Cook 1 + C ln(rate / D), 1 below D; `rate` is smoothed in place
// over part.rate_time
CRUMPLE_INLINE Real rate_factor(const Part& part, Real& rate, Real strain, double dt) {
    const double share = dt / (dt + part.rate_time);
    if (dt > 0.0) rate += share * (strain * (1.0 / dt) - rate);
    Real factor{};
    for (int i = 0; i < lanes; i++) {
        const double relative = rate[i] * part.inverse_rate_reference;
        const bool power = part.rate == Rate::power;
        const double rise = power ? __builtin_pow(relative, part.rate_exponent)
                                  : (relative > 1.0 ? part.rate_exponent * __builtin_log(relative) : 0.0);
        factor[i] = 1.0 + rise;
    }
    return factor;
}

// Work of the step's plastic strain with the mean stress of the step.  The total work uses the mean stress too, so that their
// difference is the change of the elastic energy and the stored energy never becomes negative.  With the end stress alone,
// rapidly reversing strains would be counted as dissipation beyond the energy input.
CRUMPLE_INLINE Real plastic_work(const Part& part, const Stress& old, const Stress& trial, const Stress& now) {
    const double nu = part.poissons_ratio;
    const Real dx = trial.x - now.x, dy = trial.y - now.y;
    return part.half_compliance * ((old.x + now.x) * (dx - nu * dy) + (old.y + now.y) * (dy - nu * dx)) +
           part.half_shear_compliance * ((old.xy + now.xy) * (trial.xy - now.xy));
}

// Linear hardening, for `n` points at once so that the latencies of their roots and divisions overlap.  `kept` is the share of the
// deviator that remains; returns false, with nothing changed, if no lane yields.
template <int n> CRUMPLE_INLINE bool return_linear(const Part& part, Stress (&s)[n], Real (&ep)[n], Real (&kept)[n]) {
    const double R = part.pressure_ratio, h = part.hardening * part.inverse_3g;
    Real Y[n];
    Mask yields[n], active{};
    for (int i = 0; i < n; i++) {
        Y[i] = part.yield_stress + part.hardening * ep[i];
        yields[i] = s[i].x * (s[i].x - s[i].y) + s[i].y * s[i].y + 3.0 * s[i].xy * s[i].xy > Y[i] * Y[i];
        active |= yields[i];
    }
    if (!any(active)) return false;
    // with P = 1/u, S = 1/v and Q = q P S a Newton iteration on 1/q takes one root and one division
    Real p[n], d[n], a[n], b[n], X[n], P[n], S[n], soft[n];
    Mask goes_on[n];
    for (int i = 0; i < n; i++) {
        p[i] = s[i].x + s[i].y;
        d[i] = s[i].x - s[i].y;
        a[i] = 0.25 * p[i] * p[i];
        b[i] = 0.75 * d[i] * d[i] + 3.0 * s[i].xy * s[i].xy;
        X[i] = Real{};
        P[i] = S[i] = soft[i] = all(1.0);
        goes_on[i] = yields[i];
    }
    for (int step = 0; step < max_return_steps && any(active); step++) {
        active = Mask{};
        for (int i = 0; i < n; i++) {
            const Real A = a[i] * S[i] * S[i], B = b[i] * P[i] * P[i], F = A + B, Q = root(F), wanted = Y[i] * P[i] * S[i];
            const Real residual = Q * soft[i] - wanted;
            const Real next = X[i] + residual * F / (Y[i] * (R * A * S[i] + B * P[i]) + h * F * Q);
            X[i] = goes_on[i] ? larger(next, Real{}) : X[i];
            P[i] = 1.0 + R * X[i];
            S[i] = 1.0 + X[i];
            soft[i] = 1.0 - h * X[i];
            goes_on[i] &= magnitude(residual) > last_step_residual * wanted;
            active |= goes_on[i];
        }
    }
    // commit the lanes that yield; X is 0 in the others
    for (int i = 0; i < n; i++) {
        const Real inverse = 1.0 / (P[i] * S[i] * soft[i]), u = inverse * S[i] * soft[i], v = inverse * P[i] * soft[i];
        s[i].xy = yields[i] ? s[i].xy * v : s[i].xy;
        s[i].x = yields[i] ? 0.5 * (p[i] * u + d[i] * v) : s[i].x;
        s[i].y = yields[i] ? 0.5 * (p[i] * u - d[i] * v) : s[i].y;
        ep[i] += X[i] * Y[i] * (inverse * P[i] * S[i]) * part.inverse_3g;
        kept[i] = v;
    }
    return true;
}

// Table and rate factor: the hardening segment is looked up in every Newton iteration.
CRUMPLE_INLINE bool return_general(const Part& part, Stress& s, Real& ep, Real factor, Real& kept) {
    kept = all(1.0);
    const double R = part.pressure_ratio;
    YieldLine line = yield_line(part, ep, ep, factor);
    Real p = s.x + s.y, d = s.x - s.y;
    const Real a = 0.25 * p * p, b = 0.75 * d * d + 3.0 * s.xy * s.xy;
    const Mask yields = a + b > line.value * line.value;
    if (!any(yields)) return false;
    Real X{}, u = all(1.0), v = u, q{};
    Mask active = yields;
    for (int step = 0; step < max_return_steps && any(active); step++) {
        const Real A = a * u * u, B = b * v * v;
        q = root(A + B);
        // Newton iteration on q itself, because the extrapolated value Y0 may be negative
        line = yield_line(part, ep, ep + X * q * part.inverse_3g, factor);
        const Real h = line.slope * part.inverse_3g, residual = q * (1.0 - h * X) - line.value;
        const Real next = X + residual / ((R * A * u + B * v) * (1.0 - h * X) / q + h * q);
        X = active ? larger(next, Real{}) : X;
        u = 1.0 / (1.0 + R * X);
        v = 1.0 / (1.0 + X);
        active &= magnitude(residual) > last_step_residual * q;
    }
    q = root(a * u * u + b * v * v);
    p *= u;
    d *= v;
    s.xy = yields ? s.xy * v : s.xy;
    s.x = yields ? 0.5 * (p + d) : s.x;
    s.y = yields ? 0.5 * (p - d) : s.y;
    ep += X * q * part.inverse_3g;
    kept = v;
    return true;
}

}  // namespace
}  // namespace crumple::shell
