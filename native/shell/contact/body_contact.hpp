// Touches of one rigid set with obstacles, taken together.
//
// Springs of single nodes, each a share of what the node's own wall bears, hold a heavy set softly: its lump stands
// behind all of them.  Stiffer ones would run away in the set's rotations, whose inertia may be that of the thin
// walls alone.  So every touch asks for an acceleration, k depth - c approach with k = s / dt^2, and the forces are
// those of the least 1/2 a.M a + sum w/2 max(0, asked - B a)^2 over the set's six accelerations a: never a pull, and
// no mode of the set stiffer than s / dt^2, whatever its mass and inertia.  Friction is found in the same way, with
// the pressures that came out.  Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/penalty.hpp"
#include "shell/rigid/rigid_body.hpp"

namespace crumple::shell {

struct BodyTouch {
    std::size_t item;                // whose it is
    Vec3 arm, normal;                // from the set's centre [m]; unit, out of the obstacle
    Vec3 slip;                       // velocity relative to the obstacle's surface [m/s]
    double depth;                    // [m]
    double soft;                     // factor for the sake of an obstacle's light mass
    double damping, friction;        // share of critical; Coulomb coefficient
    double share;                    // of the wall mass of all that touch of the set
    Vec3 stick;                      // acceleration that friction holds; in and out [m/s2]
    Vec3 force;                      // out, on the node [N]
};

// Finds the forces; `step` is the time step to come [s], `stiffness` the s / dt^2 [1/s2].
void hold(const RigidBody& body, const RigidState& state, double stiffness, double step, std::vector<BodyTouch>& touches);

}  // namespace crumple::shell
