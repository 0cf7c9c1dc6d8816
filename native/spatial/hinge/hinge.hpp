// Plastic hinge with one to four components: the impulse that it gives against its rates at the end of the step.
//
// A component is one of the six relative freedoms of a joint: axial slip, or a rotation about the member's local x, y
// or z.  Forces and moments tau, one per component, lie in a convex set K = {tau : g(tau_k/C_k) <= 1}; C_k is the
// capacity of a component in the sense in which it is loaded, g the section's surface (`Surface`).  As in the planar
// hinge (hinge/hinge.hpp) all that is not convex is frozen over a step of length h.  What remains, with x = tau/C,
//   set-valued       P = h tau,  tau = argmax over K of tau.w_e - (width C_ref/2) |x|^2
//   regularised      P = h Q(D(w_e)/(C_ref w_reg)) tau,  tau = argmax over K of tau.w_e,  D that maximum, Q HAVSIN
//   elastic-plastic  P = h (tau_0 + tau_1)/2,  tau_1 the point of K nearest in elastic energy to tau_0 + k h (w_0 + w)/2
// is the gradient of a convex potential, plus each component's damper and stops.  w_e = a w_0 + (1 - a) w: the end rate
// for a hinge that comes to rest, the mean for one whose axis merely turns, which keeps second order there.
// One component, and components without coupling, are planar hinges, each by itself.
//
// Softening.  One component: its own plastic rotation, largest so far in each sense.  Coupled components: one measure s of
// the plastic rotation vector e, the work D_0(e) that turning straight to e takes at the first capacities.  Each curve
// is read at s/C_k(0), the rotation about its own axis that would take that work.  `peak`: the largest s so far, both
// senses together; `rotation`: the present one; `accumulated`: the sum over all increments of e.
#pragma once

#include <limits>
#include <vector>

#include "hinge/hinge.hpp"
#include "spatial/hinge/surface.hpp"

namespace crumple::spatial {

constexpr int most_components = 4;

using hinge::Form;
using hinge::Softening;

// A component: which of the relative freedoms (translations along x, y, z: 0, 1, 2; rotations about them: 3, 4, 5), and
// its curves, stiffness, rate factor, damper and stops, as of a planar hinge.  `dof` of the law is not used.
struct Component {
    int freedom = 4;
    hinge::Hinge law;
};

// Constants of one hinge.  Form and softening are the first component's; all have the same.
struct SpatialHinge {
    std::vector<Component> components;
    Surface surface;
    double fracture = std::numeric_limits<double>::infinity();  // plastic rotation [rad] at which it opens for good
};

// State of one hinge.  Of each component: plastic rotation, moment (mean over the last step; elastic-plastic: at its
// end), total_moment (with damper and stops), capacity, energies dissipated, damped and stop_dissipated.
struct SpatialHingeState {
    hinge::HingeState component[most_components];
    double softening = 0;       // coupled: the measure s [J], largest or accumulated
    double episode = 0, accumulated = 0;  // coupled: work since it last came to rest, and ever [J]
    double rotation_max = 0;    // of the length of the rotation vector [rad]
    double opening_time = -1, rest_time = 0;  // first plastic flow (-1: none yet), last end of it [s]
    double fracture_time = -1;  // -1: whole
    double fracture_moment = 0;  // last carried about all its axes together [N m]
    double fracture_energy = 0;  // elastic energy released at fracture [J]; part of what is dissipated
    bool sliding = false;
};

// A hinge during one step; all quantities that are not convex are frozen.
struct FrozenSpatialHinge {
    double h = 0;
    double width = 0;           // half-width of the ramp [rad/s]; change it with `widen`
    double reference = 0;       // C_ref: the largest capacity of a rotation (of the slip, where it is alone)
    double lead = 0;            // a, weight of the start rate
    double power0 = 0;          // regularised: D(w0)
    double intact = 1;          // share of the step before it opens; 0: open
    double w0[most_components] = {}, tau0[most_components] = {};
    double top[2] = {0, 0};     // tension flange: the first capacity of the moment in both senses
    hinge::FrozenHinge component[most_components];  // capacities of both senses, stops, damper
    int hint[most_components][2] = {};
};

// number of components
inline int size(const SpatialHinge& hinge) { return static_cast<int>(hinge.components.size()); }
// whether one surface joins its components
bool coupled(const SpatialHinge& hinge);
// half-width of the ramp of the rigid forms [rad/s]
double ramp_width(const SpatialHinge& hinge);
// q0, w0, w1: relative rotation (components of the rotation vector) or slip at the start, rates at start and (predicted) end
FrozenSpatialHinge freeze(const SpatialHinge& hinge, const SpatialHingeState& state, double h, const double* q0, const double* w0,
                        const double* w1);
void widen(const SpatialHinge& hinge, FrozenSpatialHinge& f, double width);
// impulse (n), tangent (n x n, symmetric and positive semidefinite) and potential at end rates w, of everything and of the
// law alone, without dampers and stops; any may be null.  The potential's derivative is the impulse
void respond(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
             double* potential);
void law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
         double* potential);
// adds the contribution of dampers and stops
void add_beside(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                double* potential);
// g of the trial state: below 1 the hinge is locked (or elastic), above it flows, and the more the farther above
double load_factor(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w);
// power D(w) that a coupled hinge takes at rates w where it flows
double power_at_capacity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w);
// Of a ball or an ellipsoid that slides, rigid and set-valued: the rates at which to linearise next, with the direction of the
// impulse that the tangent gave and the power of the rates w (in and out) on it.  False where that is no forward motion
bool round(const SpatialHinge& hinge);
bool follow_impulse(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, double* w);
// scale [N m s or N s] against which an error of a component's impulse counts, at rates w
double impulse_scale(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, int k);
// d impulse_i / d ln C_j at fixed rates and ramp (n x n, row i): for implicit differentiation of a converged step
void capacity_sensitivity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* derivative);
// advances the memory; `turn` (n): the rotations and slip over the step, h (w0 + w1)/2
void commit(const SpatialHinge& hinge, const FrozenSpatialHinge& f, SpatialHingeState& state, double t0, const double* q0,
            const double* w1, double* turn);
// energies [J]: in the elastic springs; in the stops at relative rotations q; lost so far to plastic flow, dampers and stops
double elastic_energy(const SpatialHinge& hinge, const SpatialHingeState& state);
double stop_energy(const SpatialHinge& hinge, const double* q);
double dissipated(const SpatialHinge& hinge, const SpatialHingeState& state);
double damped(const SpatialHinge& hinge, const SpatialHingeState& state);
double stop_dissipated(const SpatialHinge& hinge, const SpatialHingeState& state);
// whether it is in plastic flow that counts
bool turning(const SpatialHinge& hinge, const SpatialHingeState& state);

}  // namespace crumple::spatial
