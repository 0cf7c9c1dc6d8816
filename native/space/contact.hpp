// Rigid contact between two bodies at a point: the impulse that it opposes to its rates at the end of the step.
//
// Rates w = (normal, two tangents) are those of the second body relative to the first at the point of contact, along the
// normal out of the first body, rows taken at the middle of the step.  All that is not convex is frozen over a step:
//   normal     P_n = min(0, (w_n - a)/c),  a the allowed rate, c a compliance of `softness` times the inverse mass felt
//   friction   P_t = L w_t/max(|w_t|, width),  L = mu times the normal impulse that the last pass over the step found
// so P is the gradient of a convex potential, and -P acts on the second body.  A closed contact that is run into has a = -e w_n0 (restitution e),
// one at rest a = 0; one that is still open by g may close but not overlap: a = -max(0, g/(share h) + (1/share - 1) w_n0),
// share = 1/2 for the trapezoidal step (1 where every step starts from rest).
#pragma once

#include "space/contact_geometry.hpp"

namespace crumple::space {

struct ContactLaw {
    double friction = 0, restitution = 0;
};

// What a step knows of a contact when it is frozen.
struct ContactMotion {
    double h = 0;
    double share = 0.5;          // weight of the end rate in the step's displacement
    double gap = 0;              // at the start
    double rate = 0;             // normal rate at the start
    Vec3 bias;                   // rates at the end's position less those at the middle, for the predicted end velocities
    double closed_gap = 0;       // below this gap it counts as closed [m]
    double rest_rate = 0;        // slower approach does not bounce [m/s]
    double normal_impulse = 0;   // found by the last pass, or the last step's force times h
    double inverse_mass = 1;     // n.M^-1 n of both bodies at the point
    double restitution_share = 1;  // of e; less than 1 where friction would make the impact gain energy
};

struct FrozenContact {
    double allowed = 0;          // normal rate [m/s]
    Vec3 bias;
    double compliance = 1;       // [m/s per N s]
    double limit = 0;            // of friction [N s]
    double width = 0;            // half-width of the ramp of friction [m/s]; widened while a step is solved
};

// Share of the change of rate that the stiff normal law lets pass, for two free bodies.  Larger ones show where much mass
// stands behind a light body, smaller ones cost digits of the impulse.
constexpr double softness = 1e-8;
// Sticking contacts creep at less than this rate [m/s]: 1e-9 m over 0.1 s.
constexpr double creep_rate = 1e-8;

FrozenContact freeze(const ContactLaw& law, const ContactMotion& motion);
// impulse P (3), its derivative (3 x 3, symmetric, positive semidefinite), and its potential; any may be null
void respond(const FrozenContact& f, const double* w, double* impulse, double* tangent, double* potential);

}  // namespace crumple::space
