// Convex interaction surfaces g = 1, and the points on them that a hinge law needs.
//
// Every law leads to the problem
//     maximise  y.x - 1/2 sum_k m_k x_k^2   subject to   g(x) <= 1,      m_k >= 0.
// Its solution is the point of the set closest to y/m in the metric m, or, for m = 0, the point with outward normal y.
#pragma once

#include <vector>

#include "hinge/curve.hpp"

namespace crumple::spatial {

constexpr int most_components = 4;  // of a hinge

enum class Coupling {
    none,            // independent components
    ellipsoid,       // |x|, x the forces and moments relative to their capacities
    ball,            // |x| with one capacity, a function of the angle of the relative rotation
    section,         // ([sum over rows a of |a.x|^p]^(r/p) + |t|^r)^(1/r), t the torque relative to its capacity
    tension_flange,  // the fold rotates about its tension flange, see `Flange`
};

// What the arm of a tension flange gains [m] beyond a compressive force, given as a share of the yield force.
struct ArmGain {
    double gain, share;
};
constexpr int most_arm_gains = 3;

struct Surface {
    Coupling coupling = Coupling::none;
    std::vector<double> rows;  // section: (rows, n), a column per component in their order; the torque's column is zero
    double power = 2, torque_power = 2;
    int torsion = -1;          // section: component that is the torque, or -1
    // section: rows (rows, 2) of the first component and the length of the last two, which are moments about y and z
    bool axisymmetric = false;
    double arm = 0;              // tension flange: distance of the flange from the centroid [m]
    std::vector<ArmGain> gains;  // tension flange: compression moves the axis of the fold outwards
    hinge::Curve growth;         // tension flange: share of `arm` over the largest plastic rotation so far; empty: 1
    double shortened_turn = 0;   // tension flange: rotation that a shortening counts as in the softening of the moment [rad/m]
    double alone[most_components] = {};        // section: g of the capacity of every component alone
};

// Solution of the problem: point x, value of the maximum, multiplier of g <= 1 (zero inside).
struct SurfacePoint {
    double x[most_components] = {};
    double value = 0, multiplier = 0;
};

// g of the ellipsoid, ball or section; `gradient` may be null
double gauge(const Surface& s, int n, const double* x, double* gradient);
// g^2/2, which is smooth at g = 0, with gradient (n) and curvature (n x n, rows `stride` apart); returns g^2
double half_square(const Surface& s, int n, const double* x, double* gradient, double* curvature, int stride);
// Solves the problem.  `guess` (null: none): direction of the start point; `derivative` (n x n, null: not computed): dx/dy, symmetric
// and positive semidefinite; `value_only`: the value is asked, and the point need not be exact.  Closed form for the ellipsoid with equal
// m, otherwise Newton's method.
SurfacePoint nearest(const Surface& s, int n, const double* y, const double* m, const double* guess, double* derivative,
                     bool value_only = false);

// Set of (M, N), N positive in tension: |M| <= top, |M| - N arm <= moment, the same with every gain of the arm, -crush <= N <= pull.
struct Flange {
    int axial = 0;  // which of the two components is N
    double moment = 0, top = 0, arm = 0, crush = 0, pull = 0;
    const std::vector<ArmGain>* gains = nullptr;
};
double gauge(const Flange& f, const double* x);
SurfacePoint nearest(const Flange& f, const double* y, const double* m, double* derivative);

}  // namespace crumple::spatial
