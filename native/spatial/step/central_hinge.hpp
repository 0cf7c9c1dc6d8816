// A rigid hinge on the central path of a step's problem: where hundreds of hinges lock, slide and turn at once.
//
// The shares x of the capacities that rates y load (response.cpp) satisfy y = m x + s q(x), g(x) <= 1, s >= 0 and
// s (1 - g^2) = 0, with q = g grad g.  On the central path the last is s (1 - g^2) = mu: a smooth problem, whose solution tends to
// that of the step with mu, and on which Newton's method in x, s and the velocities together hardly sees the kink between
// rest and sliding.  Rates are in units of the strongest component, y_k = C_k w_k/C_ref [rad/s].
#pragma once

#include "spatial/hinge/hinge.hpp"

namespace crumple::spatial {

// Shares x; s, and what stands for 1 - g^2 on the way, per surface: the first for coupled components, else one each.
struct CentralPoint {
    double x[most_components] = {}, slide[most_components] = {}, room[most_components] = {};
};

// whether the hinge has such a path: rigid and set-valued, whole, with a smooth surface and some capacity in every sense
bool has_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f);
// number of its surfaces: one, or one for each component
inline int surfaces(const SpatialHinge& hinge) { return coupled(hinge) ? 1 : size(hinge); }
// a point of the path for impulses and rates that are known roughly, drawn inside where the impulses are too large
CentralPoint near_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, const double* w, double mu);
// linearised at a point: impulse = offset + tangent w, tangent (n x n) symmetric and positive definite; dampers and stops apart
void path_tangent(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double mu, double* offset, double* tangent);
// the point that the linearisation gives at rates w
CentralPoint path_step(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double mu, const double* w);
// share of the way to `next`, at most all of it, that keeps s and 1 - g^2 positive
double path_share(const SpatialHinge& hinge, const CentralPoint& at, const CentralPoint& next);
CentralPoint along_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, const CentralPoint& next, double share);
// sum of s (1 - g^2) over its surfaces
double path_gap(const SpatialHinge& hinge, const CentralPoint& at);
// rates at which to linearise the law itself from here: within the ramp or beyond it
void rates_of_path(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const CentralPoint& at, double* w);

}  // namespace crumple::spatial
