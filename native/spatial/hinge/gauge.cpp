#include "spatial/hinge/gauge.hpp"

#include <algorithm>
#include <cstddef>

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// Moment over g below which the slope over it, which is the curvature there, has too few digits.
constexpr double no_moment = 1e-7;

// v^p for v >= 0; multiples of one half, which fits use, without the general power, which takes most of the time otherwise
double to_power(double v, double p) {
    const int whole = static_cast<int>(p);
    const double rest = p - whole;
    if (rest != 0 && rest != 0.5) return std::pow(v, p);
    double result = rest == 0 ? 1 : std::sqrt(v);
    for (int k = whole; k > 0; k >>= 1, v *= v) {
        if (k & 1) result *= v;
    }
    return result;
}

// v^(1/p)
double root_of(double v, double p) {
    if (p == 2) return std::sqrt(v);
    if (p == 4) return std::sqrt(std::sqrt(v));
    if (p == 16) return std::sqrt(std::sqrt(std::sqrt(std::sqrt(v))));
    return std::pow(v, 1 / p);
}

// p-norm of the linear forms a.x of all rows.
template <int n>
GaugeAt direct_gauge(const Surface& s, const double* x, Order order) {
    GaugeAt out;
    const std::size_t rows = s.rows.size() / n;
    const double* a = s.rows.data();
    double largest = 0;
    for (std::size_t i = 0; i < rows; i++) largest = std::max(largest, std::fabs(dot(n, a + i * n, x)));
    if (largest == 0) return out;
    // scale by the largest form, so that high powers neither overflow nor underflow
    double total = 0;
    for (std::size_t i = 0; i < rows; i++, a += n) {
        const double ratio = dot(n, a, x) / largest, size = std::fabs(ratio);
        const double low = to_power(size, s.power - 2), slope = low * ratio;
        total += slope * ratio;
        if (order == Order::value) continue;
        for (int j = 0; j < n; j++) {
            out.gradient[j] += slope * a[j];
            if (order == Order::gradient) continue;
            for (int k = 0; k <= j; k++) out.curvature[j][k] += low * a[j] * a[k];
        }
    }
    const double root = root_of(total, s.power);
    out.g = largest * root;
    if (order == Order::value) return out;
    const double slope_scale = root / total, bend = (s.power - 1) * root / (total * largest);
    for (int j = 0; j < n; j++) out.gradient[j] *= slope_scale;
    if (order == Order::gradient) return out;
    for (int j = 0; j < n; j++) {
        for (int k = 0; k <= j; k++) {
            out.curvature[j][k] = bend * out.curvature[j][k] - (s.power - 1) / out.g * out.gradient[j] * out.gradient[k];
            out.curvature[k][j] = out.curvature[j][k];
        }
    }
    return out;
}

// The same of a round tube, whose rows are forms of the axial force and the length of the moment.
GaugeAt axisymmetric_gauge(const Surface& s, int n, const double* x, Order order) {
    const int first = n - 2;
    const double* moment = x + first;
    const double length_of = length(2, moment), plane[2] = {x[0], length_of};
    const GaugeAt in_plane = direct_gauge<2>(s, plane, order);
    GaugeAt out;
    out.g = in_plane.g;
    if (order == Order::value || out.g == 0) return out;
    double along[2] = {};
    for (int j = 0; j < 2 && length_of > 0; j++) along[j] = moment[j] / length_of;
    out.gradient[0] = in_plane.gradient[0];
    for (int j = 0; j < 2; j++) out.gradient[first + j] = in_plane.gradient[1] * along[j];
    if (order == Order::gradient) return out;
    const double radial = in_plane.curvature[1][1], around = length_of > no_moment * out.g ? in_plane.gradient[1] / length_of : radial;
    out.curvature[0][0] = in_plane.curvature[0][0];
    for (int j = 0; j < 2; j++) {
        out.curvature[0][first + j] = out.curvature[first + j][0] = in_plane.curvature[0][1] * along[j];
        for (int k = 0; k < 2; k++) out.curvature[first + j][first + k] = (radial - around) * along[j] * along[k] + (j == k ? around : 0);
    }
    return out;
}

// Adds the sum of the squares of all rows to a curvature, times a factor.
void add_squares(const Surface& s, int n, double factor, double curvature[][most]) {
    const int columns = s.axisymmetric ? 2 : n;
    for (std::size_t i = 0; i < s.rows.size(); i += static_cast<std::size_t>(columns)) {
        const double* a = s.rows.data() + i;
        if (s.axisymmetric) {
            curvature[0][0] += factor * a[0] * a[0];
            for (int j = n - 2; j < n; j++) curvature[j][j] += factor * a[1] * a[1];
            continue;
        }
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < n; k++) curvature[j][k] += factor * a[j] * a[k];
        }
    }
}

// g = (d^r + |t|^r)^(1/r) of the direct part d and the torque t.
GaugeAt with_torque(const Surface& s, int n, const double* x, const GaugeAt& d, Order order) {
    const double torque = x[s.torsion], r = s.torque_power;
    const double t = std::fabs(torque), top = std::max(d.g, t);
    GaugeAt out;
    if (top == 0) return out;
    out.g = top * root_of(to_power(d.g / top, r) + to_power(t / top, r), r);
    if (order == Order::value) return out;
    const double u = d.g / out.g, v = t / out.g, sign = torque < 0 ? -1 : 1;
    const double flat = to_power(u, r - 2), flat_t = to_power(v, r - 2), by_d = flat * u, by_t = sign * flat_t * v;
    for (int j = 0; j < n; j++) out.gradient[j] = by_d * d.gradient[j];
    out.gradient[s.torsion] = by_t;
    if (order == Order::gradient) return out;
    const double bend = (r - 1) / out.g, dd = bend * (flat - by_d * by_d), dt = -bend * by_d * by_t;
    for (int j = 0; j < n; j++) {
        // at zero direct load its norm has a kink, which r >= 2 smooths: use the plain sum over the rows there
        for (int k = 0; k < n; k++) out.curvature[j][k] = dd * d.gradient[j] * d.gradient[k] + by_d * d.curvature[j][k];
    }
    for (int j = 0; j < n; j++) out.curvature[j][s.torsion] = out.curvature[s.torsion][j] = dt * d.gradient[j];
    if (d.g == 0) add_squares(s, n, flat / out.g, out.curvature);
    out.curvature[s.torsion][s.torsion] = bend * (flat_t - by_t * by_t);
    return out;
}

}  // namespace

GaugeAt gauge_at(const Surface& s, int n, const double* x, Order order) {
    const GaugeAt direct = s.axisymmetric ? axisymmetric_gauge(s, n, x, order)
                           : n == 1       ? direct_gauge<1>(s, x, order)
                           : n == 2       ? direct_gauge<2>(s, x, order)
                           : n == 3       ? direct_gauge<3>(s, x, order)
                                          : direct_gauge<4>(s, x, order);
    return s.torsion < 0 ? direct : with_torque(s, n, x, direct, order);
}

}  // namespace crumple::spatial
