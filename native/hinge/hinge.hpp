// One hinge kernel for all laws: the impulse that a hinge gives against its rate at the end of the step.
//
// Over a step of length h everything that is not convex in the end rate w (capacity along the softening
// curve, rate factor, for how long a stop is touched) is frozen at its prediction.  The rigid forms take the mean
// capacity over the predicted turn, so the energy under the curve is exact however sharp its kinks.  What remains is a
// non-decreasing impulse P(w), the derivative of a convex potential:
//   set-valued       P = h C sign(w), any value up to h C at w = 0 (ramp of half-width `stick_rate`)
//   elastic-plastic  P = h (M0 + M1)/2,  M1 = M0 + k h (w0 + w)/2 clamped to the capacity
//   regularised      P = h C HAVSIN(w, -w_reg, -1, w_reg, 1), its mean from w0 to w while it speeds up
//   damper           P = h c ((1 - s) w0 + s w)
//   stop             P = h f max(0, k g^e + c w),  g the mean of start and end penetration, neither below zero,
//                    f the share of the step in which it is touched, frozen
// The elastic terms use the mean of start and end, so an elastic swing keeps its energy; stops' dampers use the end
// rate, so stiff ones decay.  The hinge's own damper weighs both by s so that its decay is exact for one body: near
// the mean for a soft damper, which makes it second order, and the end rate for a stiff one.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "hinge/curve.hpp"

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using std::size_t;

// Locked hinges creep at less than this rate [rad/s]: 1e-9 rad over 0.1 s.  Larger values creep visibly,
// values below 1e-11 cost digits of the locked moment.
constexpr double stick_rate = 1e-8;

enum class Form { set_valued, elastic_plastic, regularised };
enum class Softening { peak, rotation, accumulated };

struct Stop {
    Real rotation = std::numeric_limits<double>::infinity();  // infinite: no stop
    Real stiffness = 0, exponent = 1, damping = 0, penetration = 0;
    Real force(Real g) const { return exponent == 1 ? stiffness * g : stiffness * pow(g, exponent); }
    Real energy(Real g) const { return g > 0 ? force(g) * g / (exponent + 1) : 0; }
};

// Constants of one hinge.
struct Hinge {
    int dof = 0;
    Form form = Form::set_valued;
    Softening softening = Softening::peak;
    Curve positive, negative;
    Real scale = 1;               // of both capacities
    Real stiffness = 0;           // elastic-plastic form [N m/rad]
    Real ramp_rate = 0.05;        // regularised form [rad/s]
    Real rate_reference = std::numeric_limits<double>::infinity(), rate_exponent = 1;
    Real damping = 0;             // [N m s/rad]
    Real damped_inertia = 1;      // inertia felt by the damper [kg m^2]; weighs its rates, no more
    Stop stop[2];                   // positive, negative sense
};

// State of one hinge.
struct HingeState {
    Real plastic = 0, peak[2] = {0, 0}, accumulated = 0;
    Real episode = 0;             // plastic rotation since it last came to rest
    Real overrun = 0;             // elastic-plastic: turned back within steps that still took it for plastic
    Real moment = 0;              // elastic-plastic: at the end of the last step; else its mean over it
    Real capacity = 0, total_moment = 0;  // of the sense it turns in; with dampers and stops
    Real dissipated = 0, damped = 0, stop_dissipated = 0;
    Real rotation_max = 0, moment_max = 0, rest_time = 0;
    bool sliding = false;
    int hint[2] = {0, 0};
};

// A hinge during one step; all quantities that are not convex are frozen.
struct FrozenHinge {
    double h = 0;
    Real w0 = 0, m0 = 0;
    Real width = 0;               // half-width of the ramp around zero rate [rad/s]; widened while a step is solved
    Real capacity[2] = {0, 0};
    Real damper_weight = 1;       // of the end rate in the damper's
    Real gap[2] = {0, 0};         // start penetration of each stop (negative: open)
    Real stop_damping[2] = {0, 0};
    Real touched[2] = {0, 0};     // share of the step in which each stop is touched
};

struct Response {
    Real impulse, slope;
};

// HAVSIN over x >= 0 half-widths, from x0 >= 0: its value at x, or its mean from x0 to x where it speeds up, and the
// slope of that over x.
struct Ramp {
    Real value, slope;
};

// half-width of the ramp of the rigid forms [rad/s]
Real ramp_width(const Hinge& hinge);
Ramp ramp_over(Real x0, Real x);
// integral from 0 to x of its value
Real ramp_over_integral(Real x0, Real x);
FrozenHinge freeze(const Hinge& hinge, const HingeState& state, double h, Real q0, Real w0, Real w1, int* hint);
// its parts: capacities of both senses over a plastic flow, without the rate factor; that factor; damper and stops
void set_capacity(const Hinge& hinge, const HingeState& state, Real flow, int* hint, FrozenHinge& f);
Real rate_factor(const Hinge& hinge, Real rate);
void freeze_beside(const Hinge& hinge, Real q0, Real turn, FrozenHinge& f);
// impulse of the law alone, of damper and stops alone, of the stops, and of everything
Response law_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response beside_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response stop_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response respond(const Hinge& hinge, const FrozenHinge& f, Real w);
// convex potentials whose derivatives over w are the impulses of the law, and of damper and stops
Real law_potential(const Hinge& hinge, const FrozenHinge& f, Real w);
Real beside_potential(const Hinge& hinge, const FrozenHinge& f, Real w);
// rates at which the slope of the response changes; returns how many (at most 10)
int kinks(const Hinge& hinge, const FrozenHinge& f, Real* rates);
// Advances the memory; returns the rotation over the step.  `halt`: when within the step it came to rest, should it have
// done so by the end; less than the step where that is known; null if its own moment determines it.
Real commit(const Hinge& hinge, const FrozenHinge& f, HingeState& state, double t0, Real q0, Real w1, const Real* halt);
// its part for damper and stops, the law's moment being known
void commit_beside(const Hinge& hinge, const FrozenHinge& f, HingeState& state, Real q0, Real turn, Real w1);
// elastic energy in the law's spring and in both stops at rotation q
Real elastic_energy(const Hinge& hinge, const HingeState& state);
Real stop_energy(const Hinge& hinge, Real q);
// whether it is in plastic flow that counts
bool turning(const Hinge& hinge, const HingeState& state);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
