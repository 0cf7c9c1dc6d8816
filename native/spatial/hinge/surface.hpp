// Convex surfaces of interaction g = 1, and the points of them that a hinge needs.
//
// The one problem is
//     maximise  y.x - 1/2 sum_k m_k x_k^2   subject to   g(x) <= 1,      m_k >= 0,
// the point of the set nearest to y/m in the metric m, or, for m = 0, the point where y is the outward normal.
#pragma once

#include <vector>

namespace crumple::spatial {

enum class Coupling {
    none,            // each component for itself
    ellipsoid,       // |x|, x the shares of the capacities
    ball,            // |x| with one capacity, which runs on the angle of the relative rotation
    section,         // ([sum over rows a of |a.x|^p]^(r/p) + |t|^r)^(1/r), t the torque's share
    tension_flange,  // the fold turns about its tension flange, see `Flange`
};

struct Surface {
    Coupling coupling = Coupling::none;
    std::vector<double> rows;  // section: (rows, n) over the components in their order; the torque's column is zero
    double power = 2, torque_power = 2;
    int torsion = -1;          // section: component that is the torque, or -1
    double arm = 0;            // tension flange: its distance from the centroid [m]
};

// A maximum: its place x, its value, the multiplier of g <= 1 (zero inside).
struct SurfacePoint {
    double x[4] = {0, 0, 0, 0};
    double value = 0, multiplier = 0;
};

// g of the ellipsoid, ball or section; gradient may be null
double gauge(const Surface& s, int n, const double* x, double* gradient);
// g^2/2, smooth where g is zero, with gradient (n) and curvature (n x n, rows `stride` apart); returns g^2
double half_square(const Surface& s, int n, const double* x, double* gradient, double* curvature, int stride);
// `guess` (null: none): direction in which to start; `derivative` (n x n, null: not wanted): dx/dy, symmetric and positive
// semidefinite.  Closed form for the ellipsoid with equal m, Newton's method else
SurfacePoint nearest(const Surface& s, int n, const double* y, const double* m, const double* guess, double* derivative);

// Set of (M, N), N positive in tension: |M| <= top, |M| - N arm <= moment, -crush <= N <= pull.
struct Flange {
    int axial = 0;  // which of the two components is N
    double moment = 0, top = 0, arm = 0, crush = 0, pull = 0;
};
double gauge(const Flange& f, const double* x);
SurfacePoint nearest(const Flange& f, const double* y, const double* m, double* derivative);

}  // namespace crumple::spatial
