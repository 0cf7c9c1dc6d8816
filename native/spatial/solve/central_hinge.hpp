// Rigid hinge on the central path of a step's problem (interior-point method), for steps in which hundreds of hinges lock and slide.
//
// The forces and moments relative to their capacities, x, at the rates y (response.cpp) satisfy y = m x + s q(x), g(x) <= 1, s >= 0
// and s (1 - g^2) = 0, with q = g grad g.  On the central path the last equation is s (1 - g^2) = mu: a smooth problem whose solution
// tends to that of the step for mu -> 0, and in which the kink between rest and sliding hardly affects Newton's method in x, s and
// the velocities together.  Rates are in units of the strongest component, y_k = C_k w_k/C_ref [rad/s].
#pragma once

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

// x; and per surface s (`slide`) and the variable for 1 - g^2 (`room`): only the first for coupled components, else one each.
struct CentralPoint {
    double x[most_components] = {}, slide[most_components] = {}, room[most_components] = {};
};

// Linearisation of each surface at a point: A (x_next - x) = y - pull, see `linearised`.
struct PathTangent {
    struct Surface {
        double inverse[most_components * most_components];  // of A
        double q[most_components], pull[most_components];
        double short_of;  // 1 - d - g^2, with d the variable for 1 - g^2
    } surface[most_components];
};

// whether the hinge has a central path: set-valued, not fractured, with a smooth surface and positive capacities in every sense
bool has_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f);
// number of its surfaces: one, or one for each component
inline int surfaces(const SpatialHinge& hinge) { return coupled(hinge) ? 1 : size(hinge); }
// start point near the path for estimated impulses and rates; x is drawn inside if the impulses are too large
CentralPoint near_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, const double* w, double mu);
// linearisation at a point: impulse = offset + tangent w, tangent (n x n) symmetric and positive definite; without dampers and stops
PathTangent path_tangent(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double mu, double* offset, double* tangent);
// the next point from that linearisation at rates w
CentralPoint path_step(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, const PathTangent& t, double mu, const double* w);
// share of the step to `next`, at most 1, that keeps s and 1 - g^2 positive
double path_share(const SpatialHinge& hinge, const CentralPoint& at, const CentralPoint& next);
CentralPoint along_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, const CentralPoint& next, double share);
// sum of s (1 - g^2) over its surfaces
double path_gap(const SpatialHinge& hinge, const CentralPoint& at);
// rates at which to linearise the law itself at the end of the path: within the ramp or beyond it
void rates_of_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double* w);

}  // namespace crumple::spatial
