// Rigid set of nodes: exact rigid motion; momentum and energy of a free body are conserved to round-off.
#pragma once
#include "shell/run/lowering.hpp"

namespace crumple::shell {

// Constants, in the axes at the start.  The centre is the centre of mass, or the pin of a pinned set.
struct RigidBody {
    std::vector<Index> nodes;
    std::vector<Vec3> arm;           // member minus centre at the start [m]
    std::vector<double> member_inertia;
    double mass = 0.0;               // [kg]
    Mat3 inertia;                    // about the centre, axes of the start [kg m2]
    Vec3 mass_arm;                   // centre of mass minus centre at the start [m]; not zero for a pinned body
    unsigned held = 0;               // bits 0..5: velocity prescribed (0 where fixed)
    Vec3 centre0;
};

struct RigidState {
    Vec3 centre, velocity;           // position at the step, velocity half a step earlier
    Vec3 angular_momentum, omega;    // world axes, half a step earlier
    Mat3 rotation;                   // relative to the start
};

struct Wrench {
    Vec3 force, moment;
};

RigidBody make_body(const Model& model, const RigidSet& set, const Masses& masses);
RigidState start_body(const RigidBody& body, const Model& model, const Masses& masses);
// Adds rigid motion with the linear and angular momentum of the members' velocities and spins (n, 3).
void push(const RigidBody& body, RigidState& state, const Masses& masses, const double* velocity, const double* spin);
// Inertia in world axes.
Mat3 world_inertia(const RigidBody& body, const Mat3& rotation);
// Angular velocity with given held components whose free components match the angular momentum.
Vec3 omega_of(const RigidBody& body, const Mat3& rotation, Vec3 momentum, Vec3 held_omega);
// Moves and rotates the body over dt by the implicit midpoint rule, which conserves L and L . J^-1 L / 2.
void drift(const RigidBody& body, RigidState& state, double dt, Vec3 held_omega);

}  // namespace crumple::shell
