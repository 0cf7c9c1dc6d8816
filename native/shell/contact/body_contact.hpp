// Contacts of one rigid set with obstacles, solved together.
//
// Penalty springs of single nodes, limited by the mass of each node's own wall, are too soft for a set with a large added mass.
// Stiffer springs would be unstable in the rotations of the set, whose inertia may be that of the thin walls only.  Therefore every
// contact requests an acceleration, k depth - c approach with k = s / dt^2, and the forces follow from the minimum of
//     1/2 a.M a + sum w/2 max(0, requested - B a)^2
// over the set's six accelerations a (M inertia, B a acceleration at the contact, w weights) and those of the obstacles with a mass
// along their guides.  The forces never pull, and no mode of set and obstacles is stiffer than s / dt^2, whatever their masses and
// inertia and whatever supports hold.  Friction is found in the same way from the resulting pressures.
// Theory: docs/theory/contact.md.
#pragma once
#include <algorithm>
#include <cmath>

#include "shell/contact/penalty.hpp"
#include "shell/rigid/rigid_body.hpp"

namespace crumple::shell {

struct BodyTouch {
    std::size_t item;                // item of the obstacle contact to which it belongs
    Vec3 arm, normal;                // from the set's centre [m]; unit, out of the obstacle
    Vec3 slip;                       // velocity relative to the obstacle's surface [m/s]
    double depth;                    // [m]
    int partner;                     // index of the obstacle's mass in `partners`; -1 if it is fixed or driven
    Vec3 guide;                      // unit, direction in which an obstacle with a mass moves
    double damping, friction;        // damping ratio; Coulomb coefficient
    double share;                    // of the wall mass of all contacts of the set
    Vec3 stick;                      // acceleration held by friction; input and output [m/s2]
    Vec3 force;                      // output: force on the node [N]
};

// Requested acceleration along the normal before the implicit damper divides it; a contact that requests none does not push.
inline double wanted(const BodyTouch& t, double stiffness) {
    return std::max(stiffness * t.depth - 2.0 * t.damping * std::sqrt(stiffness) * dot(t.slip, t.normal), 0.0);
}

// Computes the forces; `partners` are the masses of the obstacles on guides [kg], each its share if the obstacle touches several sets;
// `step` is the coming time step [s], `stiffness` is s / dt^2 [1/s2].
void hold(const RigidBody& body, const RigidState& state, const std::vector<double>& partners, double stiffness, double step,
          std::vector<BodyTouch>& touches);

}  // namespace crumple::shell
