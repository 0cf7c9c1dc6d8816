// One step of the spatial kernel: a convex problem for the velocities of the bodies at the end of the step.
//
// With the trapezoidal rule for the motion over the step (x1 = x0 + h (v0 + v1)/2, rotations likewise) and everything that
// depends on position evaluated at the middle of the step, the end velocities V1 (the unknowns) minimise
//     sum_bodies 1/2 |V - V*|^2_M  +  sum_laws Phi(J V + c)      subject to  G V + c = target,
// where M are the body inertias, V* the velocities without impulses of joints, J the rows of the laws with their potentials Phi, G the
// held rows, and c = J V0 - (true rates at the start), so that the rates J V1 + c belong to the end of the step.  Held rows thus do
// no work over a step.  Afterwards positions and velocities are projected onto the held rows at the end of the step with the tangents
// of the hinges kept; the corrections are errors of third order.
#pragma once

#include <cstdint>
#include <vector>

#include "spatial/solve/newton.hpp"
#include "spatial/step/contact_step.hpp"
#include "spatial/step/end_of_step.hpp"
#include "spatial/step/loops.hpp"
#include "spatial/step/pass_records.hpp"
#include "spatial/step/vibration_filter.hpp"

namespace crumple::spatial {

class Stepper {
public:
    explicit Stepper(const Model& model);

    State start();
    Stage& stage() { return p_.stage; }
    const Stage& stage() const { return p_.stage; }
    // adds velocities and impulses: the result is the closest compatible motion in the kinetic-energy norm, with all hinges free
    void add_motion(State& state, const Twist* velocity, const Twist* impulse);
    // One step of length h; false if the equations did not converge (the state is then undefined).  `guess`: end velocities known to
    // first order; without them the step predicts them by a first pass.  `discarded`: no step follows, so contacts that it overlooked do
    // not matter, and friction keeps the normal impulses of the step before.
    bool step(State& state, double h, const std::vector<Twist>* guess, bool discarded = false);
    // redundant held rows at the start: number, and per joint
    int redundant() const { return redundant_; }
    const std::vector<int>& redundant_rows() const { return redundant_rows_; }
    int held_rows() const;
    double displacement(const Drive& drive, size_t index, const State& s, double t) const { return p_.displacement(drive, index, s, t); }
    // prepares `effective_inertia` in this state
    void free_hinges(const State& state);
    // effective inertia (mass for a slip) at a component of a hinge with all hinges free
    double effective_inertia(size_t hinge, int component);
    // kinetic norm of the structure's response to a unit impulse of these loads, with all hinges free and contacts open
    double moved_by(const State& state, const std::vector<size_t>& loads);
    // displacement in a freedom of a joint, in the axes of its first body
    double relative(const State& state, int joint, int freedom) const;
    // filter at the end of the last step; and whether hinges vibrate
    VibrationFilter& filter() { return filter_; }
    bool elastic() const { return p_.elastic; }
    // index of a hinge's first component in State::rotation
    int first_component(size_t hinge) const { return p_.component[hinge]; }
    const std::vector<Twist>& end_velocity() const { return p_.velocity; }
    // rates along the rows at the end of the last step; and begins the next step's search for locked hinges with such rates
    const std::vector<double>& end_rates() const { return p_.w; }
    void start_from(const std::vector<double>& rates) { newton_.start_from(rates); }
    // body at the link with the largest imbalance in the last Newton iteration; -1: the ground
    int stuck_body() const { return newton_.stuck_body(); }
    // begins a stage with these obstacles
    void set_obstacles(const std::vector<bool>& present, const State& state) { p_.contacts.begin(present, state.pose); }
    // finds whether bodies approach at a closed contact in this state
    void look_for_impact(State& state);
    Contacts& contacts() { return p_.contacts; }
    int rows() const { return p_.system.rows(); }
    // Smallest half-width of a hinge's ramp around zero rate [rad/s], the rate at which locked hinges creep.  With many locked hinges, a
    // narrow ramp leaves too few digits for the moments that equilibrium does not determine.
    void set_narrowest_ramp(double width) { p_.narrowest_ramp = width; }
    std::int64_t solves() const { return newton_.solves(); }
    // `keep` stores the solutions of the passes from now on, `follow` uses those of another run; null ends either
    void keep(std::vector<Pass>* passes) { records_.keep(passes); }
    void follow(const std::vector<Pass>* passes) { records_.follow(passes); }

private:
    // stages of a step
    void begin(State& s, double h, const std::vector<Twist>* guess, bool discarded);
    void place_middle(const State& s, double h);
    void aim(const State& s, double h);
    void freeze(const State& s, double h);
    bool solve();
    bool settle();
    // parts of the stages
    void gather(State& s, double h, double gain);
    void predict(const State& s, double h);
    void set_free(const State& s);
    void divide_shared_rotations(const State& s);
    void freeze_spring(const State& s, double h, size_t link);
    bool keeps_place() const;
    void follow_pass();
    bool turned_back();
    void find_redundant(const std::vector<Pose>& poses);

    Problem p_;
    NewtonSolver newton_;
    ContactStep contact_;
    EndOfStep end_;
    PassRecords records_;
    Loops loops_;
    VibrationFilter filter_;
    std::vector<Twist> direction_, momentum_, guess_;
    std::vector<Twist> change_;      // of the velocities by the last pass, and the share of it that was taken
    double share_ = 1;
    std::vector<char> turned_back_;  // per hinge: whether it reversed in a pass over the present step
    int turns_ = 0;                  // passes over the present step in which contacts took the load in turns
    int redundant_ = 0;
    std::vector<int> redundant_rows_;
};

}  // namespace crumple::spatial
