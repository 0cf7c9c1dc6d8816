// One hinge kernel for all laws: the moment impulse P of a hinge over a step as a function of its rate w at the end of the step.
//
// Over a step of length h from rate w0 everything that is not convex in w (capacity C on the softening curve, rate factor,
// share of the step in which a stop is touched) is frozen at its predicted value.  The rigid forms (set-valued, regularised)
// use the mean capacity over the predicted rotation, so that the energy under the curve is exact even across kinks.  The
// remaining impulse P(w) is non-decreasing, the derivative of a convex potential:
//   set-valued       P = h C sign(w), any value up to h C at w = 0 (ramp of half-width `stick_rate`)
//   elastic-plastic  P = h ((1 - s) M0 + s M1),  M1 = M0 + k h (w0 + w)/2 clamped to the capacity;  s = 1/2 in motion
//   regularised      P = h C HAVSIN(w, -w_reg, -1, w_reg, 1); while |w| grows, the mean of HAVSIN from w0 to w
//   damper           P = h c ((1 - s) w0 + s w)
//   stop             P = h f max(0, k g^e + c w),  g the mean of the start and end penetrations (each at least zero),
//                    f the share of the step in which the stop is touched, frozen
// In motion the elastic terms use the mean of start and end and therefore conserve energy.  Without inertia this mean passes every error
// of M0 on to M1 with opposite sign, for ever; with s > 1/2 it decays, and (s - 1/2) (M1 - M0)^2/k is damped.  The dampers of the stops
// use the end rate, so that stiff ones decay.  The weight s of the end rate in the hinge's damper makes the decay of a single body exact: close to
// 1/2 for a soft damper (second order), close to 1 for a stiff one.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "hinge/curve.hpp"

namespace crumple::hinge {
inline namespace CRUMPLE_ARITHMETIC {

using std::size_t;

// Locked hinges creep at less than this rate [rad/s]: 1e-9 rad over 0.1 s.  Larger values give visible creep; below 1e-11 the
// moment of a locked hinge loses digits.
constexpr double stick_rate = 1e-8;

enum class Form { set_valued, elastic_plastic, regularised };
enum class Softening { peak, rotation, accumulated };

struct Stop {
    Real rotation = std::numeric_limits<double>::infinity();  // infinite: no stop
    Real stiffness = 0, exponent = 1, damping = 0, penetration = 0;
    Real force(Real g) const { return exponent == 1 ? stiffness * g : stiffness * pow(g, exponent); }
    Real energy(Real g) const { return g > 0 ? force(g) * g / (exponent + 1) : 0; }
};

// Parameters of one hinge.
struct Hinge {
    int dof = 0;
    Form form = Form::set_valued;
    Softening softening = Softening::peak;
    Curve positive, negative;
    Real scale = 1;               // factor on both capacities
    Real stiffness = 0;           // elastic-plastic form [N m/rad]
    Real ramp_rate = 0.05;        // regularised form [rad/s]
    Real rate_reference = std::numeric_limits<double>::infinity(), rate_exponent = 1;
    Real damping = 0;             // [N m s/rad]
    Real damped_inertia = 1;      // effective inertia at the damper [kg m^2]; used only for the weight s of the end rate
    Stop stop[2];                   // in positive and negative sense
};

// State of one hinge.
struct HingeState {
    Real plastic = 0, peak[2] = {0, 0}, accumulated = 0;
    Real episode = 0;             // plastic rotation since it last came to rest
    Real overrun = 0;             // elastic-plastic: reversed rotation within steps that still treated it as plastic
    Real moment = 0;              // elastic-plastic: at the end of the last step; other forms: mean over that step
    Real capacity = 0, total_moment = 0;  // capacity in the present sense of rotation; moment including damper and stops
    Real dissipated = 0, damped = 0, stop_dissipated = 0;
    Real rotation_max = 0, moment_max = 0, rest_time = 0;
    bool sliding = false;
    int hint[2] = {0, 0};
};

// Length of a step, and the weight s of the moment at its end in the impulse of an elastic-plastic hinge.
struct Span {
    double h = 0, late = 0.5;
};

// A hinge during one step; all quantities that are not convex are frozen.
struct FrozenHinge {
    double h = 0, late = 0.5;     // see `Span`
    Real w0 = 0, m0 = 0;
    Real width = 0;               // half-width of the ramp around zero rate [rad/s]; the solution may widen it temporarily
    Real capacity[2] = {0, 0};
    Real damper_weight = 1;       // weight s of the end rate in the damper
    Real gap[2] = {0, 0};         // start penetration of each stop (negative: open)
    Real stop_damping[2] = {0, 0};
    Real touched[2] = {0, 0};     // share of the step in which each stop is touched
};

struct Response {
    Real impulse, slope;
};

// Regularised sign of a rate of x >= 0 half-widths (HAVSIN), from a rate x0 >= 0 at the start: its value at x, or its mean from x0
// to x if the rate grows, and the derivative of either over x.
struct Ramp {
    Real value, slope;
};

// half-width of the ramp around zero rate of the rigid forms [rad/s]
Real ramp_width(const Hinge& hinge);
Ramp ramp_over(Real x0, Real x);
// integral of the ramp's value from 0 to x
Real ramp_over_integral(Real x0, Real x);
FrozenHinge freeze(const Hinge& hinge, const HingeState& state, Span step, Real q0, Real w0, Real w1, int* hint);
// the parts of `freeze`: capacities of both senses over a plastic flow, without the rate factor; that factor; damper and stops
void set_capacity(const Hinge& hinge, const HingeState& state, Real flow, int* hint, FrozenHinge& f);
Real rate_factor(const Hinge& hinge, Real rate);
void freeze_beside(const Hinge& hinge, Real q0, Real turn, FrozenHinge& f);
// impulses of the law alone, of damper and stops, of the stops alone, and of everything
Response law_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response beside_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response stop_response(const Hinge& hinge, const FrozenHinge& f, Real w);
Response respond(const Hinge& hinge, const FrozenHinge& f, Real w);
// convex potentials whose derivatives over w are the impulses of the law and of damper and stops
Real law_potential(const Hinge& hinge, const FrozenHinge& f, Real w);
Real beside_potential(const Hinge& hinge, const FrozenHinge& f, Real w);
// rates at which the slope of the response changes; returns their number (at most 10)
int kinks(const Hinge& hinge, const FrozenHinge& f, Real* rates);
// Updates the state variables; returns the rotation over the step.  `halt`: time within the step at which a hinge comes to rest
// that is at rest at the end of the step, the step length if that time is unknown; null: the hinge's own impulse gives it.
Real commit(const Hinge& hinge, const FrozenHinge& f, HingeState& state, double t0, Real q0, Real w1, const Real* halt);
// the part of `commit` for damper and stops, once the moment of the law is known
// energy that the weight of the end moment takes from a step of an elastic-plastic hinge
inline Real damped_by_weight(const Hinge& hinge, const FrozenHinge& f, Real m1) {
    return (f.late - 0.5) * (m1 - f.m0) * (m1 - f.m0) / hinge.stiffness;
}
void commit_beside(const Hinge& hinge, const FrozenHinge& f, HingeState& state, Real q0, Real turn, Real w1);
// elastic energy in the law's spring and in both stops at rotation q
Real elastic_energy(const Hinge& hinge, const HingeState& state);
Real stop_energy(const Hinge& hinge, Real q);
// whether the hinge is in plastic flow beyond the smallest episode that counts
bool turning(const Hinge& hinge, const HingeState& state);

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::hinge
