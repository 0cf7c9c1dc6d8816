// Constants of a spatial model, and the state of a run.
#pragma once

#include <cmath>
#include <vector>

#include "spatial/contact/contacts.hpp"
#include "spatial/hinge/hinge.hpp"
#include "spatial/model/joint.hpp"

namespace crumple::spatial {

using hinge::Curve;
using std::size_t;

struct Body {
    double mass = 1;
    Mat3 inertia, inverse;  // about the centre, in the body's frame (aligned with the world axes at the start)
    Vec3 centre;            // at the start
    bool obstacle = false;  // not part of the structure: its energy counts when it is transferred to the structure
    bool stand_in = false;  // body of a driven obstacle: its inertia is a placeholder and its energy does not count
};

// Force and moment on a body, with directions fixed in the world, times a function of time.
struct Load {
    int body = 0;
    Vec3 arm, force, moment;
    Curve value;
};

// Linear spring and damper between two points.
struct Spring {
    int body[2] = {-1, -1};
    Vec3 arm[2];
    double stiffness = 0, length = 0, damping = 0;
};

// Prescribed displacement of one held freedom of a joint.  The rate is piecewise linear in time and the displacement is its integral:
// if both were sampled independently, their inconsistency over a short step would act as a jerk.
struct Drive {
    int joint = 0, freedom = 0;
    double start = 0;
    Curve rate;
};

struct Model {
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<SpatialHinge> hinges;
    std::vector<int> hinge_joint;
    std::vector<Load> loads;
    std::vector<Spring> springs;
    std::vector<Drive> drives;
    ContactModel contact;
    Vec3 gravity;
    double length = 1;  // [m] reference length that converts displacements to angles in the error measure
    double resolved_frequency = INFINITY;  // [Hz] vibration of elastic hinges above it does not count in the error measure
    std::vector<double> breaks;  // [s] after the start of a stage, increasing: times at which steps end

    Pose pose(const std::vector<Pose>& poses, int body) const { return body < 0 ? Pose{} : poses[static_cast<size_t>(body)]; }
    Twist twist(const std::vector<Twist>& twists, int body) const {
        return body < 0 ? Twist{} : twists[static_cast<size_t>(body)];
    }
};

// State of a drive in the present stage: an inactive drive holds its position.
struct DriveStage {
    bool acts = true;
    double origin = 0;  // displacement at the start of the stage
};

struct State {
    double t = 0, stage_start = 0;
    std::vector<Pose> pose;
    std::vector<Twist> velocity, acceleration;  // at the centres, world axes; acceleration: mean of the last step
    std::vector<Twist> travel;                  // rotation and displacement of the centres in the last step, world axes
    double last_step = 0;                       // length of the last step [s]
    std::vector<SpatialHingeState> hinge;
    std::vector<double> rotation;               // of every hinge component, see JointGeometry::error
    std::vector<double> turned;                 // the same as used by the hinge laws: for several rotations the integral of their
                                                // rates, which unlike the rotation vector is conjugate to their moments
    std::vector<double> rate;                   // rates of these
    std::vector<Twist> joint_force;             // moment and force on the second body, in the joint's frame, mean of the last step
    ContactState contact;
    double external_work = 0, spring_damped = 0;
    double slowed = 0;                          // kinetic energy that quasi-static stages removed
    double obstacle_work = 0;                   // part of the external work: that on obstacles
    double load_work = 0, dragged = 0;          // quasi-static: work of loads and gravity on the structure, and energy lost to drag
    // takes what is a mean of the last step from another state
    void take_means(const State& other) {
        acceleration = other.acceleration;
        travel = other.travel;
        last_step = other.last_step;
        joint_force = other.joint_force;
        contact.force = other.contact.force;
    }
    void work_on(bool obstacle, double work) {
        external_work += work;
        if (obstacle) obstacle_work += work;
    }
};

struct Energies {
    double kinetic = 0, elastic = 0, dissipated = 0, damped = 0, stop = 0, spring = 0, contact = 0, friction = 0, external_work = 0;
    double slowed = 0;  // kinetic energy removed by quasi-static stages
    double obstacle_kinetic = 0, obstacle_work = 0;  // parts of obstacles in the kinetic energy and the external work
    double structure_kinetic() const { return kinetic - obstacle_kinetic; }
    // energy that obstacles have transferred to the structure, up to a constant
    double given() const { return obstacle_work - obstacle_kinetic; }
    double balance() const {
        return kinetic + elastic + dissipated + damped + stop + spring + contact + friction + slowed - external_work;
    }
};

Energies energies(const Model& model, const State& state);

}  // namespace crumple::spatial
