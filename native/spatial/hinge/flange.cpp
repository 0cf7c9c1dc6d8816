// The set of a fold that turns about its tension flange: sides and corners of a polygon.
#include <algorithm>
#include <cmath>

#include "spatial/hinge/surface.hpp"

namespace crumple::spatial {

namespace {

double dot(const double* a, const double* b) {
    double sum = 0;
    for (int k = 0; k < 2; k++) sum += a[k] * b[k];
    return sum;
}

double objective(const double* y, const double* m, const double* x) {
    double f = 0;
    for (int k = 0; k < 2; k++) f += (y[k] - m[k] * x[k] / 2) * x[k];
    return f;
}

// Half-planes (coefficient of N, coefficient of M, bound) for M >= 0; M < 0 is mirrored.
struct Side {
    double a[2], bound;
};

constexpr int most_sides = 5 + most_arm_gains;

// The last one is M >= 0, which bounds nothing.
int sides(const Flange& f, Side* out) {
    int count = 0;
    out[count++] = {{0, 1}, f.top};
    out[count++] = {{-f.arm, 1}, f.moment};
    double bound = f.moment, gained = 0;
    for (size_t i = 0; f.gains != nullptr && i < f.gains->size(); i++) {
        // meets the side before where the compressive force is the share of the yield force
        const ArmGain& next = (*f.gains)[i];
        bound += (next.gain - gained) * next.share * f.pull;
        gained = next.gain;
        out[count++] = {{-f.arm - gained, 1}, bound};
    }
    out[count++] = {{-1, 0}, f.crush};
    out[count++] = {{1, 0}, f.pull};
    out[count++] = {{0, -1}, 0};
    return count;
}

}  // namespace

double gauge(const Flange& f, const double* x) {
    const double at[2] = {x[f.axial], std::fabs(x[1 - f.axial])};
    Side side[most_sides];
    const int count = sides(f, side);
    double g = 0;
    for (int i = 0; i < count - 1; i++) g = std::max(g, dot(side[i].a, at) / side[i].bound);
    return g;
}

// The maximum lies inside, on a side of the polygon, or at a corner.  A point on a side is computed along that side: computed from
// the unconstrained maximum far outside, it would miss the side by rounding.
SurfacePoint nearest(const Flange& f, const double* y, const double* m, double* derivative) {
    const int order[2] = {f.axial, 1 - f.axial};
    const double sign = y[order[1]] < 0 ? -1 : 1;
    const double load[2] = {y[order[0]], sign * y[order[1]]}, metric[2] = {m[order[0]], m[order[1]]};
    SurfacePoint p;
    double x[2] = {0, 0}, block[4] = {0, 0, 0, 0}, best = -1;
    auto finish = [&] {
        p.value = objective(load, metric, x);
        for (int i = 0; i < 2; i++) {
            p.x[order[i]] = i == 0 ? x[0] : sign * x[1];
            for (int j = 0; j < 2 && derivative != nullptr; j++) derivative[2 * order[i] + order[j]] = (i == j ? 1 : sign) * block[2 * i + j];
        }
        return p;
    };
    Side side[most_sides];
    const int count = sides(f, side);
    bool inside = metric[0] > 0 && metric[1] > 0;
    if (inside) {
        for (int i = 0; i < 2; i++) x[i] = load[i] / metric[i], block[3 * i] = 1 / metric[i];
        for (int i = 0; i < count; i++) inside = inside && dot(side[i].a, x) <= side[i].bound;
        if (inside) return finish();
        block[0] = block[3] = 0;
    }
    for (int i = 0; i < count - 1; i++) {
        const double* a = side[i].a;
        const double square = dot(a, a), foot[2] = {a[0] * side[i].bound / square, a[1] * side[i].bound / square}, along[2] = {-a[1], a[0]};
        double low = -1e300, high = 1e300;
        for (int j = 0; j < count; j++) {
            const double slope = dot(side[j].a, along), left = side[j].bound - dot(side[j].a, foot);
            if (j == i || (slope == 0 && left >= 0)) continue;
            if (slope == 0) high = -1e300;
            if (slope > 0) high = std::min(high, left / slope);
            if (slope < 0) low = std::max(low, left / slope);
        }
        if (!(low <= high)) continue;
        const double stiffness = metric[0] * along[0] * along[0] + metric[1] * along[1] * along[1];
        const double pull[2] = {load[0] - metric[0] * foot[0], load[1] - metric[1] * foot[1]};
        const double place = stiffness > 0 ? dot(along, pull) / stiffness : high;
        for (const double s : {place, low, high}) {
            const double at[2] = {foot[0] + s * along[0], foot[1] + s * along[1]};
            const double outward = a[0] * (load[0] - metric[0] * at[0]) + a[1] * (load[1] - metric[1] * at[1]);
            const bool between = s > low && s < high;
            if (s == place && !(between && outward >= 0)) continue;
            const double value = objective(load, metric, at);
            if (!between && !(value > best)) continue;
            best = value, x[0] = at[0], x[1] = at[1], p.multiplier = outward / square;
            if (!between) continue;
            for (int j = 0; j < 4; j++) block[j] = along[j / 2] * along[j % 2] / stiffness;
            return finish();
        }
    }
    return finish();
}

}  // namespace crumple::spatial
