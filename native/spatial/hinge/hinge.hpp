// Plastic hinge with one to four components: its impulse over a step as a function of its rates at the end of the step.
//
// A component is one of the six relative freedoms of a joint: axial slip, or a rotation about the member's local x, y
// or z.  Forces and moments tau, one per component, lie in a convex set K = {tau : g(tau_k/C_k) <= 1}; C_k is the
// capacity of a component in the sense in which it is loaded, g the section's interaction surface (`Surface`).  As in the
// planar hinge (hinge/hinge.hpp) all that is not convex is frozen over a step of length h.  What remains, with x = tau/C,
//   set-valued       P = h tau,  tau = argmax over K of tau.w_e - (width C_ref/2) |x|^2
//   regularised      P = h Q(D(w_e)/(C_ref w_reg)) tau,  tau = argmax over K of tau.w_e,  D that maximum, Q HAVSIN
//   elastic-plastic  P = h ((1 - s) tau_0 + s tau_1),  tau_1 the point of K nearest in elastic energy to tau_0 + k h (w_0 + w)/2
// is the gradient of a convex potential, plus each component's damper and stops.  w_e = a w_0 + (1 - a) w is the end rate
// for a hinge that comes to rest, and the mean rate for one whose axis only rotates, which keeps second order.
// A single component, and components without coupling, are independent planar hinges.
//
// Softening.  One component: its own plastic rotation, largest so far in each sense.  Coupled components: one measure s of the plastic
// rotation vector e, the work D_0(e) of a proportional rotation to e at the initial capacities.  Each curve is evaluated at s/C_k(0),
// the rotation about its own axis that would dissipate that work.  A component can have a weight in both (`Component::softens`); the moments
// of tubes of two pairs of walls soften less by rotation about the other axis (`SpatialHinge::cross_softening`), and less if they bend about both (`edge_relief`).  `peak`: the largest s so far, both senses together; `rotation`:
// the present s; `accumulated`: the sum of s over all increments of e.  What spreads over the member (`Component::spread`) is left out of e.
#pragma once

#include <limits>
#include <vector>

#include "hinge/hinge.hpp"
#include "spatial/hinge/surface.hpp"

namespace crumple::spatial {

using hinge::Form;
using hinge::Softening;

// A component: the relative freedom (translations along x, y, z: 0, 1, 2; rotations about them: 3, 4, 5), and its curves, stiffness,
// rate factor, damper and stops, as for a planar hinge.  `dof` of the law is not used.
struct Component {
    int freedom = 4;
    hinge::Hinge law;
    // Over the largest rotation so far about the component `driver` (no points: none): share by which the centre of the set has moved along
    // this one, and share of its capacity that is gone.  With a shift the initial capacity of the driver is also the weight of this one in the
    // measure of softening.
    hinge::Curve shift, worn;
    int driver = -1;
    // Over the largest flow so far of the component, in either sense: share of its capacity in the positive and the negative sense before
    // it has flowed so far (no points: all of it).  Flow up to the end of the curve of its sense does not soften the hinge.
    hinge::Curve spread[2];
    double softens = 1;  // weight of its rotation in the measure of softening, over that of its initial capacity
    double flange = 0;   // distance [m] of the flange about which its fold turns; tension acts there against the fold, see `hold_by_tension`
};

// Parameters of one hinge.  All components have the form and softening of the first one.
struct SpatialHinge {
    std::vector<Component> components;
    Surface surface;
    double fracture = std::numeric_limits<double>::infinity();  // plastic rotation [rad] at which the hinge fractures
    double shear_loss[2] = {0, 0};  // share of the torque that a shear force along local y, z takes from the walls [1/N]
    bool round_shear = false;       // whether the walls see the resultant of both forces
    double cross_softening = 1;     // weight of a rotation about y in what softens the moment about z, and of one about z in that about y
    double edge_relief = 0;         // share of the measure that does not soften the moments about y and z if both do the same work
};

// State of one hinge.  Used of each component: plastic rotation, moment (mean over the last step; elastic-plastic: at its end),
// total_moment (including damper and stops), capacity, and the energies dissipated, damped and stop_dissipated.
struct SpatialHingeState {
    hinge::HingeState component[most_components];
    double softening = 0;       // coupled, with a capacity that varies: the measure s [J], largest or accumulated
    double softening_of[most_components] = {};  // the same of every component, with a weight of cross softening
    double work = 0;            // the same, coupled by a section's surface: D_0(e) of the plastic rotation e so far [J]
    double along[most_components] = {};  // the point of the surface where it is found
    double episode = 0, accumulated = 0;  // coupled, elastic: plastic work since the hinge last came to rest, and in total [J]
    double rotation_max = 0;    // largest length of the rotation vector [rad]
    double opening_time = -1, rest_time = 0;  // start of the first plastic flow (-1: none yet), end of the last one [s]
    double fracture_time = -1;  // -1: not fractured
    double fracture_moment = 0;  // resultant moment just before fracture [N m]
    double fracture_energy = 0;  // elastic energy released at fracture [J]; part of the dissipated energy
    double torque_left = 1, torque_aim = 1;  // share of the torque that shear forces leave, followed in time, and of the last step's
    double tension = 0, tension_aim = 0;     // axial force [N], likewise
    double most_pressed = 0, most_pulled = 0;  // largest of it so far in either sense [N]
    bool sliding = false;
};

// A hinge during one step; all quantities that are not convex are frozen.
struct FrozenSpatialHinge {
    double h = 0, late = 0.5;   // see `hinge::Span`
    double width = 0;           // half-width of the ramp [rad/s]; to be changed with `widen`
    double reference = 0;       // C_ref: the largest capacity of a rotation (of the slip if there is no rotation)
    double lead = 0;            // a, weight of the start rate in w_e
    double power0 = 0;          // regularised: D(w0)
    double intact = 1;          // share of the step before fracture; 0: fractured
    double w0[most_components] = {}, tau0[most_components] = {};
    double top[2] = {0, 0};     // tension flange: initial capacity of the moment in both senses
    double grown = 1;           // tension flange: share of its arm
    hinge::FrozenHinge component[most_components];  // capacities of both senses, stops, damper; of a shifted set its half axes
    double shift[most_components] = {}, centre[most_components] = {};  // share of the shift, and the centre of K
    // Quasi-static: what a capacity grows by with its own rotation over the step [N m/rad or N/m]; without coupling set by `divide_shared`.
    double slope[most_components] = {};
    // Quasi-static: what a moment grows by with its rate, and with its rate beyond `expected`, the one at which its capacity is frozen
    // [N m s or N s]; see "Hinges that share a rotation" in docs/theory/spatial_kernel.md.
    double viscous[most_components] = {}, growth[most_components] = {}, expected[most_components] = {};
    int hint[most_components][2] = {};
    // Coupled: the point of the surface found last, from which the next search starts.  Results depend on it by rounding alone.
    mutable double found[most_components] = {};
};

// number of components
inline int size(const SpatialHinge& hinge) { return static_cast<int>(hinge.components.size()); }
// whether its components interact by a common surface
bool coupled(const SpatialHinge& hinge);
// half-width of the ramp around zero rate of the rigid forms [rad/s]
double ramp_width(const SpatialHinge& hinge);
// q0, w0, w1: relative rotation (components of the rotation vector) or slip at the start, rates at start and (predicted) end
FrozenSpatialHinge freeze(const SpatialHinge& hinge, const SpatialHingeState& state, hinge::Span step, const double* q0, const double* w0,
                        const double* w1);
// force of an elastic-plastic component at the end of a step from its impulse
inline double end_of(const FrozenSpatialHinge& f, int k, double impulse) { return (impulse / f.h - (1 - f.late) * f.tau0[k]) / f.late; }
inline double dividing_moment(const FrozenSpatialHinge& f, int k, double w) { return f.viscous[k] * w + f.growth[k] * (w - f.expected[k]); }
void widen(const SpatialHinge& hinge, FrozenSpatialHinge& f, double width);
// Impulse (n), tangent (n x n, symmetric and positive semidefinite) and potential at the end rates w: `respond` for everything, `law`
// without dampers and stops; any pointer may be null.  The impulse is the gradient of the potential.
void respond(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
             double* potential);
void law(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
         double* potential);
// adds the contribution of dampers, stops, and of what divides a shared rotation
void add_beside(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* impulse, double* tangent,
                double* potential);
// Quasi-static steps: lets moments grow with the rotation of the step as their laws do, and by a small `share` of a capacity at the rate
// `fastest` (0: by none).
void divide_shared(const SpatialHinge& hinge, const SpatialHingeState& state, FrozenSpatialHinge& f, double share, double fastest);
// g of the trial state: below 1 the hinge is locked (or elastic), above 1 it flows
double load_factor(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w);
// power D(w) that a coupled hinge dissipates in plastic flow at rates w
double power_at_capacity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w);
// For a sliding, set-valued hinge with a ball or ellipsoid surface (`round`): replaces the rates w by those at which to linearise next,
// in the direction of the impulse found with the tangent and with the power of w on it.  False if that is not a forward motion.
bool round(const SpatialHinge& hinge);
bool follow_impulse(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* impulse, double* w);
// reference value [N m s or N s] for the relative error of a component's impulse at rates w
double impulse_scale(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, int k);
// d impulse_i / d ln C_j at fixed rates and ramp (n x n, row i): for implicit differentiation of a converged step
void capacity_sensitivity(const SpatialHinge& hinge, const FrozenSpatialHinge& f, const double* w, double* derivative);
// share of the torque that a shear force (local y, z) [N] leaves
double left_by_shear(const SpatialHinge& hinge, double along_y, double along_z);
// Capacities of a fold that has softened, which turns about one flange: tension there works against it.  By a distance d of the flange from
// the axis and a tension N its moment grows by N d, up to that of the section that has not softened; by a part of N d while it has lost a
// small part of that.  `factor`: of the rate, on all capacities.
void hold_by_tension(const SpatialHinge& hinge, double tension, double factor, FrozenSpatialHinge& f, int k);
// updates the state variables; `turn` (n): the rotations and slip over the step, h (w0 + w1)/2
void commit(const SpatialHinge& hinge, const FrozenSpatialHinge& f, SpatialHingeState& state, double t0, const double* q0,
            const double* w1, double* turn);
// length of the vector of its moments, with dampers and stops [N m]; forces along axes are no part of it.
double length_of_moment(const SpatialHinge& hinge, const SpatialHingeState& state);
// energies [J]: of the elastic springs; of the stops at relative rotations q; dissipated so far by plastic flow, dampers and stops
double elastic_energy(const SpatialHinge& hinge, const SpatialHingeState& state);
double stop_energy(const SpatialHinge& hinge, const double* q);
double dissipated(const SpatialHinge& hinge, const SpatialHingeState& state);
double damped(const SpatialHinge& hinge, const SpatialHingeState& state);
double stop_dissipated(const SpatialHinge& hinge, const SpatialHingeState& state);
// whether the hinge is in plastic flow beyond the smallest episode that counts
bool turning(const SpatialHinge& hinge, const SpatialHingeState& state);

}  // namespace crumple::spatial
