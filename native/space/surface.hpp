// Convex surfaces of interaction g(x) = 1 in the shares x = tau/C of the capacities, and the points of them that a hinge needs.
//
// The one problem is
//     maximise  y.x - 1/2 sum_k m_k x_k^2   subject to   g(x) <= 1,      m_k >= 0,
// the point of the set nearest to y/m in the metric m, or, for m = 0, the point where y is the outward normal.
#pragma once

#include <vector>

namespace crumple::space {

enum class Coupling {
    none,            // |x_k| <= 1, each for itself
    ellipsoid,       // |x|
    ball,            // |x| with one capacity, which runs on the angle of the relative rotation
    section,         // ([sum_rows |a.(n, m_y, m_z)|^p]^(r/p) + |t|^r)^(1/r)
    tension_flange,  // |M| + N arm <= C (N compression), |M| <= the first C, -N_t <= N <= N_c
};

struct Surface {
    Coupling coupling = Coupling::none;
    std::vector<double> rows;  // section: (rows, n) over the components in their order; torsion's column is zero
    double power = 2, torque_power = 2;
    int torsion = -1;          // section: component that is the torque, or -1
    double arm = 0;            // tension flange: distance from the centroid to the flange that it turns about [m]
};

// Point x (n), its multiplier, and the derivative dx/dy (n x n, symmetric, positive semidefinite; may be null).
struct SurfacePoint {
    double x[4] = {0, 0, 0, 0};
    double value = 0;       // of the maximum
    double multiplier = 0;  // of g <= 1; zero inside
};

// g and its gradient (may be null); not for the tension flange
double gauge(const Surface& s, int n, const double* x, double* gradient);
// `guess`: direction of a point to start from, or null
SurfacePoint nearest(const Surface& s, int n, const double* y, const double* m, const double* guess, double* derivative);

}  // namespace crumple::space
