#include "spatial/hinge/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>

#include "spatial/hinge/gauge.hpp"

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// Limit of Newton iterations on the surface; about five are usual, more are needed at the edges of surfaces with high powers.
constexpr int newton_limit = 80;
constexpr int halvings = 40;
// Loads below this count as zero: their squares and inverses would underflow or overflow.
constexpr double smallest_load = 1e-280;
// Residual relative to the load y at which the iteration has converged: a few rounding errors of the sum over rows.
constexpr double converged = 1e-15;
// The same where only the value is asked: at the maximum its error is of second order, the square of this over a curvature of the surface.
constexpr double value_converged = 1e-9;
// Bound of g up to which a point is inside whatever the rounding of g itself.
constexpr double surely_inside = 1 - 1e-9;

// Solves a x = b by Gauss elimination with pivoting; a (n x n) and b (n x columns) are overwritten.  A zero pivot is made tiny.
void solve(int n, double a[][most + 1], double b[][most + 1], int columns) {
    for (int j = 0; j < n; j++) {
        int p = j;
        for (int i = j + 1; i < n; i++) {
            if (std::fabs(a[i][j]) > std::fabs(a[p][j])) p = i;
        }
        for (int k = 0; k < n; k++) std::swap(a[j][k], a[p][k]);
        for (int k = 0; k < columns; k++) std::swap(b[j][k], b[p][k]);
        if (a[j][j] == 0) a[j][j] = 1e-300;
        for (int i = j + 1; i < n; i++) {
            const double factor = a[i][j] / a[j][j];
            if (factor == 0) continue;
            for (int k = j; k < n; k++) a[i][k] -= factor * a[j][k];
            for (int k = 0; k < columns; k++) b[i][k] -= factor * b[j][k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = 0; k < columns; k++) {
            for (int j = i + 1; j < n; j++) b[i][k] -= a[i][j] * b[j][k];
            b[i][k] /= a[i][i];
        }
    }
}

// The same at the point g = 1 on the ray through x: the gradient is unchanged, the curvature scales with 1/|x|.
GaugeAt on_surface(int n, GaugeAt at, double* x) {
    for (int j = 0; j < n; j++) {
        x[j] /= at.g;
        for (int k = 0; k < n; k++) at.curvature[j][k] *= at.g;
    }
    at.g = 1;
    return at;
}

double objective(int n, const double* y, const double* m, const double* x) {
    double f = 0;
    for (int k = 0; k < n; k++) f += (y[k] - m[k] * x[k] / 2) * x[k];
    return f;
}

// Bordered matrix of Newton's method in (x, multiplier): [M + multiplier H, normal; normal^T, 0].
void bordered(int n, const double* m, double multiplier, const GaugeAt& at, double a[][most + 1]) {
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) a[j][k] = multiplier * at.curvature[j][k] + (j == k ? m[j] : 0);
        a[j][n] = a[n][j] = at.gradient[j];
    }
    a[n][n] = 0;
}

void inverse_block(int n, const double* m, double multiplier, const GaugeAt& at, double* derivative) {
    double a[most + 1][most + 1], b[most + 1][most + 1] = {};
    bordered(n, m, multiplier, at, a);
    for (int k = 0; k < n; k++) b[k][k] = 1;
    solve(n + 1, a, b, n);
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) derivative[j * n + k] = (b[j][k] + b[k][j]) / 2;
    }
}

// A point where a search may begin, with its g.
struct Start {
    const double* x;
    double g;
};

// The point where a search begins: of the given ones, put on the surface, that with the largest objective.
double begin_at(int n, const double* y, const double* m, std::initializer_list<Start> starts, double* x) {
    double best = -1;
    for (const Start& start : starts) {
        double trial[most];
        if (!(start.g > 0)) continue;
        for (int k = 0; k < n; k++) trial[k] = start.x[k] / start.g;
        const double f = objective(n, y, m, trial);
        if (f <= best) continue;
        best = f;
        std::copy(trial, trial + n, x);
    }
    return best;
}

// Newton's method on the surface: a step in the tangent plane, then back to g = 1 along the ray.  The multiplier is that of the
// radial direction, which is exact at the solution.  The objective never decreases, so the iteration converges from any start.
SurfacePoint on_section(const Surface& s, int n, const double* y, const double* m, Start free, const double* guess, double* derivative,
                        bool value_only) {
    SurfacePoint p;
    const double load = length(n, y);
    const double tolerance = value_only ? value_converged : converged;
    const Start near{guess, guess ? gauge(s, n, guess, nullptr) : 0};
    // the largest work is sought from one rotation to the next, so the point before is near
    double best = value_only ? begin_at(n, y, m, {near}, p.x) : 0;
    if (!(best > 0)) {
        if (free.g == 0) free = {y, gauge(s, n, y, nullptr)};
        best = begin_at(n, y, m, {free, near}, p.x);
    }
    GaugeAt at = gauge_at(s, n, p.x, Order::curvature);
    auto residual = [&](const double* x, const GaugeAt& here, double* r) {
        double multiplier = 0;
        for (int k = 0; k < n; k++) multiplier += x[k] * (y[k] - m[k] * x[k]);
        for (int k = 0; k < n; k++) r[k] = y[k] - m[k] * x[k] - multiplier * here.gradient[k];
        return multiplier;
    };
    double r[most];
    p.multiplier = residual(p.x, at, r);
    double left = length(n, r);
    for (int iteration = 0; iteration < newton_limit && left > tolerance * load; iteration++) {
        double a[most + 1][most + 1], b[most + 1][most + 1] = {};
        bordered(n, m, std::max(p.multiplier, 1e-3 * load), at, a);
        for (int k = 0; k < n; k++) b[k][0] = r[k];
        solve(n + 1, a, b, 1);
        double step[most], along = 0;
        for (int k = 0; k < n; k++) step[k] = b[k][0], along += step[k] * r[k];
        double share = std::min(1.0, 0.5 * length(n, p.x) / length(n, step));
        bool moved = false;
        for (int halving = 0; halving < halvings && !moved; halving++, share /= 2) {
            double trial[most], trial_r[most];
            for (int k = 0; k < n; k++) trial[k] = p.x[k] + share * step[k];
            const GaugeAt there = on_surface(n, gauge_at(s, n, trial, Order::curvature), trial);
            const double f = objective(n, y, m, trial);
            const double multiplier = residual(trial, there, trial_r), remains = length(n, trial_r);
            // sufficient increase (Armijo); close to the maximum, where the increase is lost in rounding, the residual decides
            if (!(f >= best + 1e-4 * share * along) && !(remains < 0.5 * left && f >= best - 1e-12 * load)) continue;
            std::copy(trial, trial + n, p.x);
            std::copy(trial_r, trial_r + n, r);
            moved = f > best || remains < left;
            best = f, at = there, p.multiplier = multiplier, left = remains;
        }
        if (!moved) break;
    }
    p.value = objective(n, y, m, p.x);
    if (derivative != nullptr) inverse_block(n, m, p.multiplier, at, derivative);
    return p;
}

// Secular equation |y/(m + multiplier)| = 1: the reciprocal of its left side is concave, so Newton's method converges monotonically.
SurfacePoint on_ellipsoid(int n, const double* y, const double* m, double* derivative) {
    SurfacePoint p;
    bool equal = true;
    for (int k = 1; k < n; k++) equal = equal && m[k] == m[0];
    const double load = length(n, y);
    if (equal) {
        p.multiplier = load - m[0];
    } else {
        // no component of x exceeds 1, so the multiplier is at least this
        p.multiplier = 1e-300;
        for (int k = 0; k < n; k++) p.multiplier = std::max(p.multiplier, std::fabs(y[k]) - m[k]);
        for (int iteration = 0; iteration < newton_limit; iteration++) {
            double square = 0, weighed = 0;
            for (int k = 0; k < n; k++) {
                const double d = m[k] + p.multiplier, x = y[k] / d;
                square += x * x;
                weighed += x * x / d;
            }
            const double size = std::sqrt(square), rise = square / weighed * (size - 1);
            if (!(rise > 1e-16 * p.multiplier)) break;
            p.multiplier += rise;
        }
    }
    for (int k = 0; k < n; k++) p.x[k] = y[k] / (m[k] + p.multiplier);
    const double size = length(n, p.x);
    for (int k = 0; k < n; k++) p.x[k] /= size;
    p.value = objective(n, y, m, p.x);
    if (derivative == nullptr) return p;
    double across[most], weight = 0;
    for (int k = 0; k < n; k++) across[k] = p.x[k] / (m[k] + p.multiplier), weight += across[k] * p.x[k];
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) derivative[j * n + k] = (j == k ? 1 / (m[j] + p.multiplier) : 0) - across[j] * across[k] / weight;
    }
    return p;
}

}  // namespace

double gauge(const Surface& s, int n, const double* x, double* gradient) {
    if (s.coupling == Coupling::section) {
        const GaugeAt at = gauge_at(s, n, x, gradient != nullptr ? Order::gradient : Order::value);
        if (gradient != nullptr) std::copy(at.gradient, at.gradient + n, gradient);
        return at.g;
    }
    const double g = length(n, x);
    for (int k = 0; k < n && gradient != nullptr; k++) gradient[k] = g > 0 ? x[k] / g : 0;
    return g;
}

// At g = 0, and for the ellipsoid everywhere, the curvature is the unit matrix.
double half_square(const Surface& s, int n, const double* x, double* gradient, double* curvature, int stride) {
    const bool section = s.coupling == Coupling::section;
    const GaugeAt at = section ? gauge_at(s, n, x, Order::curvature) : GaugeAt{};
    for (int j = 0; j < n; j++) {
        gradient[j] = section ? at.g * at.gradient[j] : x[j];
        for (int k = 0; k < n; k++) {
            curvature[j * stride + k] = at.g > 0 ? at.gradient[j] * at.gradient[k] + at.g * at.curvature[j][k] : (j == k ? 1 : 0);
        }
    }
    return section ? at.g * at.g : dot(n, x, x);
}

namespace {

// Whether a bound shows that g <= 1: g is a norm, so it is at most the sum over the components alone.  Most hinges of a structure are
// loaded so little that this decides.
bool surely_within(const Surface& s, int n, const double* x) {
    double bound = 0;
    for (int k = 0; k < n; k++) bound += std::fabs(x[k]) * s.alone[k];
    return s.coupling == Coupling::section && bound <= surely_inside;
}

}  // namespace

SurfacePoint nearest(const Surface& s, int n, const double* y, const double* m, const double* guess, double* derivative,
                     bool value_only) {
    SurfacePoint p;
    bool inside = true, weighed = true;
    for (int k = 0; k < n; k++) {
        inside = inside && (m[k] > 0 || y[k] == 0);
        weighed = weighed && m[k] > 0;
        p.x[k] = m[k] > 0 ? y[k] / m[k] : 0;
    }
    double largest = 0;
    for (int k = 0; k < n; k++) largest = std::max(largest, std::fabs(y[k]));
    const double g = inside && largest > smallest_load && !surely_within(s, n, p.x) ? gauge(s, n, p.x, nullptr) : 0;
    if (largest > smallest_load && (!inside || g > 1)) {
        const SurfacePoint free = p;
        double load[most], metric[most];
        for (int k = 0; k < n; k++) load[k] = y[k] / largest, metric[k] = m[k] / largest;
        p = s.coupling == Coupling::section ? on_section(s, n, load, metric, {free.x, weighed ? g : 0}, guess, derivative, value_only)
                                            : on_ellipsoid(n, load, metric, derivative);
        p.value *= largest;
        p.multiplier *= largest;
        for (int k = 0; k < n * n && derivative != nullptr; k++) derivative[k] /= largest;
        return p;
    }
    p.value = objective(n, y, m, p.x);
    for (int k = 0; k < n * n && derivative != nullptr; k++) derivative[k] = 0;
    for (int k = 0; k < n && derivative != nullptr; k++) derivative[k * n + k] = m[k] > 0 ? 1 / m[k] : 0;
    return p;
}

}  // namespace crumple::spatial
