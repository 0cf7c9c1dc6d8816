// Rigid contact between two bodies at a point: its impulse over a step as a function of its rates at the end of the step.
//
// Rates (normal, two tangents) are those of the second body relative to the first at the point of contact, along the
// outward normal of the first body.  The normal rate is measured relative to the allowed rate a, which is frozen over a step:
//   at rest            a = 0
//   impact             a = -e r_0, r_0 the rate at the start, e the restitution
//   open by a gap g    a = -max(0, 2 g/h + r_0): it may close, but with trapezoidal motion not overlap at the end
// With this relative rate w, the impulse P is the gradient of a convex potential, and -P acts on the second body:
//   normal     P_n = max(-F h, min(0, w_n/c)),  c a compliance, `softness` times the inverse effective mass, F the force at which
//              walls crush at the point of contact (infinite for a rigid contact)
//   friction   P_t = L w_t/max(|w_t|, width),  L = mu times the normal impulse found by the last pass over the step
#pragma once

#include <cmath>
#include <cstddef>

#include "spatial/contact/contact_geometry.hpp"

namespace crumple::spatial {

using std::size_t;

struct ContactLaw {
    double friction = 0, restitution = 0;
};

// A contact over one step.
struct FrozenContact {
    double compliance = 1;  // [m/s per N s]
    double cap = INFINITY;  // largest normal impulse [N s]
    double limit = 0;       // of friction [N s]
    double width = 0;       // half-width of the ramp of friction [m/s]; widened while a step is solved
};

// Share of the change of rate that the stiff normal law does not suppress, for two free bodies.  Larger values are noticeable when a
// large mass acts through a light body; smaller ones cost digits of the impulse.
constexpr double softness = 1e-8;
// Sticking contacts creep at less than this rate [m/s]: 1e-7 m over 0.1 s.  Smaller values cost Newton iterations.
constexpr double creep_rate = 1e-6;

// allowed rate from gap and normal rate at the start of a step of length h; a gap up to `closed` counts as closed, an approach up to
// `rest` is not an impact
double allowed_rate(double restitution, double gap, double rate, double h, double closed, double rest);
double friction_limit(const ContactLaw& law, double normal_impulse);
FrozenContact freeze(const ContactLaw& law, double inverse_mass, double normal_impulse, double cap);
// impulse P (n), its derivative (n x n, symmetric, positive semidefinite), and its potential; any may be null.  n rates: 3, or the normal
// rate alone
void respond(const FrozenContact& f, size_t n, const double* w, double* impulse, double* tangent, double* potential);

}  // namespace crumple::spatial
