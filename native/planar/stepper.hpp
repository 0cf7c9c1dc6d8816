// One step of the planar kernel: a convex problem for the joint rates at the end of the step.
//
// With the trapezoidal rule for the motion over the step (q1 = q0 + h (w0 + w1)/2) and everything that depends on position
// evaluated at the middle of the step, the joint rates w1 at its end (the unknowns) minimise
//     sum_bodies 1/2 |T w - V*|^2_M  +  sum_hinges Phi_j(w_j)      subject to  G w = g,
// where V* are the body velocities without joint impulses, M the body inertias, T the map from joint rates to body velocities,
// Phi_j the potential of hinge j (hinge.hpp) and G w = g the drives, holds and welds.  The potential is minimised by a semismooth
// Newton method with exact line search; each Newton step is one O(N) articulated-body solve.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "hinge/hinge.hpp"
#include "planar/tree.hpp"

namespace crumple::planar {
inline namespace CRUMPLE_ARITHMETIC {

// Force or moment on a body: direction (rotation, x, y) fixed in the world, at a point of the body.
struct Load {
    int body = 0;
    Vec2 point;
    Twist direction;
    Curve value;
    Real scale = 1;
};

// Prescribed motion of a point of a body in one direction.  The rate is piecewise linear and the displacement is its integral: if
// both were sampled independently, their inconsistency over a short step would act as a jerk.
struct Drive {
    int body = 0;
    Vec2 point;
    Twist direction;
    Real start = 0;  // displacement at time 0
    Curve rate;
};

// Rigid connection of two bodies, which closes a loop.  A body in a loop is cut in two halves, each with its own inboard joint, and
// the weld holds the halves together; every hinge thus remains a joint coordinate of the tree.
struct Weld {
    int body = 0, other = -1;  // -1: the ground
    Vec2 point, other_point;   // the same point in the frame of each body (world frame for the ground)
};

// A point of a body that is held in one direction by a support.
struct Hold {
    int body = 0;
    Vec2 point;
    Twist direction;
};

struct Model {
    Tree tree;
    std::vector<Hinge> hinges;
    std::vector<Load> loads;
    std::vector<Drive> drives;
    std::vector<Hold> holds;
    std::vector<Weld> welds;
    Vec2 gravity;
    std::vector<Real> q0;  // reference joint coordinates
    Real length = 1;       // [m] reference length that converts translations of free bodies to angles in the error measure
    std::vector<double> breaks;  // [s] increasing: jumps and kinks of loads and drives, where steps end
    double resolved_frequency = INFINITY;  // [Hz] vibration of elastic hinges above it does not count in the error measure
};

struct State {
    double t = 0;
    std::vector<Real> q, w;
    std::vector<Pose> pose;       // at q
    std::vector<Twist> velocity;  // of the centres of mass, at q and w
    std::vector<HingeState> hinge;
    std::vector<Real> drive_impulse;  // mean force of every drive over the last step [N]
    Real external_work = 0;
};

struct Energies {
    Real kinetic = 0, elastic = 0, dissipated = 0, damped = 0, stop = 0, external_work = 0;
    Real balance() const { return kinetic + elastic + dissipated + damped + stop - external_work; }
};

Energies energies(const Model& model, const State& state);
// Kinetic-energy norm of velocities, or of the difference of two velocity fields [m/s kg^1/2].
double kinetic_norm(const Tree& tree, const std::vector<Twist>& a, const std::vector<Twist>* b);

class Stepper {
public:
    // Passes over the frozen quantities: the second evaluates them at the middle of the motion found by the first, which makes the
    // step second-order accurate.
    static constexpr int most_passes = 2;
    explicit Stepper(const Model& model);

    // state with these joint coordinates and rates
    State start(const Real* q, const Real* w) const;
    // joint rates closest, in the kinetic-energy norm, to given velocities of the centres of mass plus body impulses at them
    void project(const State& at, const Twist* velocity, const Twist* impulse, Real* w);
    // One step of length h; false if the equations did not converge (the state is then unchanged).  `guess`: end rates from which
    // the iteration starts; if their error is O(h^2) or smaller, one pass is sufficient.
    bool step(State& state, double h) { return step(state, h, state.w.data(), most_passes); }
    bool step(State& state, double h, const Real* guess, int passes);
    // effective inertia at a joint coordinate with all other hinges free: 1 / (J M^-1 J^T)
    Real effective_inertia(const State& at, int dof);
    // Kinetic norm of the response of the structure, with all hinges free, to a unit impulse of these loads times their scales.
    double moved_by(const State& at, const std::vector<size_t>& loads);
    // The parts of changes of rates and of joint coordinates that vibrate slowly enough to count, (M + T^2 K)^-1 M of each, at a state that
    // a step has just reached: M the inertias, K the stiffness of the laws there, T = 1/(2 pi frequency).  A vibration of the frequency f
    // keeps the share 1/(1 + (f/frequency)^2); hinges that flow have no stiffness, locked ones stay locked, and held directions are kept.
    void filter(const State& at, Real* rates, Real* turns);
    // kinetic norm of joint rates
    double speed_of(const State& at, const Real* rates);
    // whether the error measure passes over vibration
    bool filters() const { return elastic_ && std::isfinite(model_.resolved_frequency); }
    // whether prescribed motion begins with another rate than the structure has
    bool jerked(const State& at) const;
    // Smallest time constant for the correction of the drift of drives.  Without it the time constant would be twice the step, and
    // the drift of a long step would jerk a short step that follows.
    void set_drift_time(double time) { drift_time_ = time; }
    std::int64_t solves() const { return solves_; }

private:
    void predict(const State& s, double h);
    void freeze(const State& s, double h);
    bool newton();
    bool descend(int limit, bool full_steps);
    void take_full_step();
    void linearise();
    void differentiate();
    void solve_once();
    // one constrained direction: motion of a point of a body relative to a point of another body or of the ground
    struct Row {
        int body = 0, other = -1;
        Vec2 point, other_point;
        Twist direction;
        Real origin = 0;  // relative position at the start
    };
    void add_row(const Row& row);
    Real relative(const Row& row, const Pose* pose) const;
    Real row_rate(const Row& row, const Pose* pose, const Twist* twist) const;
    void aim_rows(const State& s, double h);
    void constrain(Real* w, size_t first);
    void keep_joined(const State& at, Real* w, size_t first);
    void slow(const State& at, Real* change, bool again);
    void momentum(const State& at, const Real* rates);
    Real search(Real slope_end);
    void find_loops();
    Real common_halt(double h) const;
    void commit(State& s, double h);
    Vec2 arm(int body, Vec2 point, const Pose* pose) const { return pose[body].turned(point); }

    const Model& model_;
    ArticulatedSolver solver_;
    std::vector<FrozenHinge> frozen_;
    std::vector<Real> w_, next_, direction_, rhs_, impedance_, dq_, column_, breakpoints_, overload_, overload_of_children_;
    std::vector<Pose> middle_, end_;
    std::vector<Twist> twist_, end_twist_, bias_, work_;
    std::vector<Row> rows_;  // the drives, the holds, then three per weld
    std::vector<Real> row_target_, row_rates_, row_matrix_, row_force_, zero_;
    std::vector<int> hint_;
    std::vector<bool> looped_;  // hinges that are part of a loop
    bool all_set_valued_ = true, elastic_ = false;
    double drift_time_ = 0;
    std::int64_t solves_ = 0;
};

}  // namespace CRUMPLE_ARITHMETIC
}  // namespace crumple::planar
