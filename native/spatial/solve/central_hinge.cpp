#include "spatial/solve/central_hinge.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::spatial {

namespace {

constexpr int most = most_components;
// Largest share of the distance to the boundary that a step takes (step to the boundary rule).
constexpr double inside = 0.99;

const Surface ellipsoid{Coupling::ellipsoid, {}, 2, 2, -1, 0, {}, {}, {}};

// One surface: components first to first + n of a hinge.
struct Part {
    int first, n;
    const Surface* surface;
    double reference, width, lead;
};

int parts_of(const SpatialHinge& hinge, const FrozenSpatialHinge& f, Part* parts) {
    if (coupled(hinge)) {
        parts[0] = {0, size(hinge), &hinge.surface, f.reference, f.width, f.lead};
        return 1;
    }
    for (int k = 0; k < size(hinge); k++) parts[k] = {k, 1, &ellipsoid, 0, f.width, 0};
    return size(hinge);
}

double capacity(const FrozenSpatialHinge& f, int k, double share) { return f.component[k].capacity[share < 0 ? 1 : 0]; }

double seen(const Part& p, const FrozenSpatialHinge& f, int k, double w) { return p.lead * f.w0[k] + (1 - p.lead) * w; }

// capacity of a component over the part's reference
double weight(const Part& p, const FrozenSpatialHinge& f, int k, double share) {
    return p.reference > 0 ? capacity(f, k, share) / p.reference : 1;
}

void invert(int n, double a[most][most], double* out) {
    // Cholesky
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < j; k++) a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = std::sqrt(std::max(a[j][j], 1e-300));
        for (int i = j + 1; i < n; i++) {
            for (int k = 0; k < j; k++) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (int c = 0; c < n; c++) {
        double b[most] = {};
        b[c] = 1;
        for (int i = 0; i < n; i++) {
            for (int k = 0; k < i; k++) b[i] -= a[i][k] * b[k];
            b[i] /= a[i][i];
        }
        for (int i = n - 1; i >= 0; i--) {
            for (int k = i + 1; k < n; k++) b[i] -= a[k][i] * b[k];
            b[i] /= a[i][i];
        }
        for (int i = 0; i < n; i++) out[i * n + c] = b[i];
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) out[i * n + j] = out[j * n + i] = (out[i * n + j] + out[j * n + i]) / 2;
    }
}

// A = m + s H + 2 s/d q q^T, pull = m x + (mu - s r)/d q, r = 1 - d - g^2, H the curvature of g^2/2.
PathTangent::Surface linearised(const Part& p, const CentralPoint& at, int i, double mu) {
    const double *x = at.x + p.first, s = at.slide[i], d = at.room[i];
    PathTangent::Surface out;
    double a[most][most] = {};
    const double g2 = half_square(*p.surface, p.n, x, out.q, &a[0][0], most);
    out.short_of = 1 - d - g2;
    for (int j = 0; j < p.n; j++) out.pull[j] = p.width * x[j] + (mu - s * out.short_of) / d * out.q[j];
    if (p.surface->coupling != Coupling::section) {
        const double base = p.width + s, b = 2 * s / d, share = b / (base + b * g2);
        for (int j = 0; j < p.n; j++) {
            for (int k = 0; k < p.n; k++) out.inverse[j * p.n + k] = ((j == k ? 1 : 0) - share * out.q[j] * out.q[k]) / base;
        }
        return out;
    }
    for (int j = 0; j < p.n; j++) {
        for (int k = 0; k < p.n; k++) a[j][k] = s * a[j][k] + 2 * s / d * out.q[j] * out.q[k] + (j == k ? p.width : 0);
    }
    invert(p.n, a, out.inverse);
    return out;
}

}  // namespace

bool has_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f) {
    if (hinge.components[0].law.form != Form::set_valued || hinge.surface.coupling == Coupling::tension_flange || f.intact <= 0) return false;
    for (int k = 0; k < size(hinge); k++) {
        if (!(std::min(f.component[k].capacity[0], f.component[k].capacity[1]) > 0)) return false;
    }
    return true;
}

CentralPoint near_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, const double* w, double mu) {
    CentralPoint out;
    Part parts[most];
    const int number = parts_of(hinge, f, parts);
    for (int i = 0; i < number; i++) {
        const Part& p = parts[i];
        double square = 0;
        for (int k = p.first; k < p.first + p.n; k++) {
            const double beyond = impulse[k] / f.h - f.centre[k];
            out.x[k] = beyond / capacity(f, k, beyond);
            const double y = weight(p, f, k, w[k]) * seen(p, f, k, w[k]);
            square += y * y;
        }
        // draw x inside to where s is about as large as the rate
        const double most_share = std::sqrt(1 - mu / std::max(2 * mu, std::sqrt(square)));
        const double g = gauge(*p.surface, p.n, out.x + p.first, nullptr), kept = std::min(g, most_share);
        for (int k = p.first; k < p.first + p.n && g > kept; k++) out.x[k] *= kept / g;
        out.room[i] = 1 - kept * kept;
        out.slide[i] = mu / out.room[i];
    }
    return out;
}

PathTangent path_tangent(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double mu, double* offset, double* tangent) {
    PathTangent out;
    Part parts[most];
    const int n = size(hinge), number = parts_of(hinge, f, parts);
    std::fill(tangent, tangent + n * n, 0.0);
    for (int i = 0; i < number; i++) {
        const Part& p = parts[i];
        const PathTangent::Surface& l = out.surface[i] = linearised(p, at, i, mu);
        for (int j = 0; j < p.n; j++) {
            const int row = p.first + j;
            const double scale = f.h * capacity(f, row, at.x[row]);
            offset[row] = f.h * f.centre[row] + scale * at.x[row];
            for (int k = 0; k < p.n; k++) {
                const int column = p.first + k;
                const double c = weight(p, f, column, at.x[column]);
                offset[row] += scale * l.inverse[j * p.n + k] * (c * p.lead * f.w0[column] - l.pull[k]);
                tangent[row * n + column] = scale * l.inverse[j * p.n + k] * c * (1 - p.lead);
            }
        }
    }
    return out;
}

CentralPoint path_step(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, const PathTangent& t, double mu, const double* w) {
    CentralPoint next;
    Part parts[most];
    const int number = parts_of(hinge, f, parts);
    for (int i = 0; i < number; i++) {
        const Part& p = parts[i];
        const PathTangent::Surface& l = t.surface[i];
        double along = 0;
        for (int j = 0; j < p.n; j++) {
            double step = 0;
            for (int k = 0; k < p.n; k++) {
                const int c = p.first + k;
                step += l.inverse[j * p.n + k] * (weight(p, f, c, at.x[c]) * seen(p, f, c, w[c]) - l.pull[k]);
            }
            next.x[p.first + j] = at.x[p.first + j] + step;
            along += l.q[j] * step;
        }
        const double s = at.slide[i], d = at.room[i];
        next.room[i] = d + l.short_of - 2 * along;
        next.slide[i] = (mu - s * l.short_of + 2 * s * along) / d;
    }
    return next;
}

double path_share(const SpatialHinge& hinge, const CentralPoint& at, const CentralPoint& next) {
    double share = 1;
    for (int i = 0; i < surfaces(hinge); i++) {
        if (next.slide[i] < (1 - inside) * at.slide[i]) share = std::min(share, inside * at.slide[i] / (at.slide[i] - next.slide[i]));
        if (next.room[i] < (1 - inside) * at.room[i]) share = std::min(share, inside * at.room[i] / (at.room[i] - next.room[i]));
    }
    return share;
}

double path_gap(const SpatialHinge& hinge, const CentralPoint& at) {
    double sum = 0;
    for (int i = 0; i < surfaces(hinge); i++) sum += at.slide[i] * at.room[i];
    return sum;
}

CentralPoint along_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, const CentralPoint& next, double share) {
    CentralPoint out;
    for (int k = 0; k < size(hinge); k++) {
        out.x[k] = at.x[k] + share * (next.x[k] - at.x[k]);
        out.x[k] *= capacity(f, k, at.x[k]) / capacity(f, k, out.x[k]);
        out.slide[k] = at.slide[k] + share * (next.slide[k] - at.slide[k]);
        out.room[k] = at.room[k] + share * (next.room[k] - at.room[k]);
    }
    return out;
}

void rates_of_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double* w) {
    Part parts[most];
    const int number = parts_of(hinge, f, parts);
    for (int i = 0; i < number; i++) {
        const Part& p = parts[i];
        double q[most], unused[most][most] = {};
        const double g2 = half_square(*p.surface, p.n, at.x + p.first, q, &unused[0][0], most), g = std::sqrt(g2);
        const bool rests = at.slide[i] < p.width * at.room[i];
        for (int j = 0; j < p.n; j++) {
            const int k = p.first + j;
            const double share = at.x[k], y = rests ? p.width * share : (p.width * share / g + at.slide[i] * q[j]);
            w[k] = (y / weight(p, f, k, share) - p.lead * f.w0[k]) / (1 - p.lead);
        }
    }
}

}  // namespace crumple::spatial
