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

#include <algorithm>
#include <cstdint>
#include <vector>

#include "spatial/step/central_hinge.hpp"
#include "spatial/run/step_record.hpp"
#include "spatial/model/model.hpp"
#include "spatial/step/loops.hpp"
#include "spatial/step/system.hpp"

namespace crumple::spatial {

// Drag coefficient of quasi-static stages per mass [1/s], the only resistance to motion out of equilibrium.  A step begins at rest and
// ends with twice its mean velocity, so the share drag h/2 of the inertia gives the force drag m v for any step length, and motion out
// of equilibrium does not depend on the steps.  Smaller values need more steps if loads rotate with the structure; larger ones become
// noticeable.
constexpr double drag = 0.1;
// Smallest share of the inertia, for very short steps: less would be lost in rounding.
constexpr double least_inertia = 1e-8;

struct Stage {
    bool quasi_static = false;
    std::vector<DriveStage> drives;
};

class Stepper {
public:
    explicit Stepper(const Model& model);

    State start();
    Stage& stage() { return stage_; }
    const Stage& stage() const { return stage_; }
    // adds velocities and impulses: the result is the closest compatible motion in the kinetic-energy norm, with all hinges free
    void add_motion(State& state, const Twist* velocity, const Twist* impulse);
    // One step of length h; false if the equations did not converge (the state is then undefined).  `guess`: end velocities known to
    // first order; without them the step predicts them by a first pass.
    bool step(State& state, double h, const std::vector<Twist>* guess);
    // redundant held rows at the start: number, and per joint
    int redundant() const { return redundant_; }
    const std::vector<int>& redundant_rows() const { return redundant_rows_; }
    int held_rows() const;
    double displacement(const Drive& drive, size_t index, const State& s, double t) const;
    // effective inertia (mass for a slip) at a component of a hinge with all hinges free
    double effective_inertia(const State& state, size_t hinge, int component);
    // kinetic norm of the structure's response to a unit impulse of these loads, with all hinges free and contacts open
    double moved_by(const State& state, const std::vector<size_t>& loads);
    // displacement in a freedom of a joint, in the axes of its first body
    double relative(const State& state, int joint, int freedom) const;
    // index of a hinge's first component in State::rotation
    int first_component(size_t hinge) const { return component_[hinge]; }
    const std::vector<Twist>& end_velocity() const { return velocity_; }
    // body at the link with the largest imbalance in the last Newton iteration; -1: the ground
    int stuck_body() const { return stuck_body_; }
    // begins a stage with these obstacles
    void set_obstacles(const std::vector<bool>& present, const State& state) { contacts_.begin(present, state.pose); }
    // finds whether bodies approach at a closed contact in this state
    void look_for_impact(State& state);
    Contacts& contacts() { return contacts_; }
    int rows() const { return system_.rows(); }
    // Smallest half-width of a hinge's ramp around zero rate [rad/s], the rate at which locked hinges creep.  With many locked hinges, a
    // narrow ramp leaves too few digits for the moments that equilibrium does not determine.
    void set_narrowest_ramp(double width) { narrowest_ramp_ = width; }
    std::int64_t solves() const { return solves_; }
    // `keep` stores the solutions of the passes from now on, `follow` uses those of another run; null ends either
    void keep(std::vector<Pass>* passes) { kept_ = passes; }
    void follow(const std::vector<Pass>* passes) { followed_ = passes, next_pass_ = 0; }

private:
    // Linearisation of a law, P = offset + root root^T w, at the rates where it was last evaluated.
    struct Tangent {
        double offset[most_components] = {};
        double vectors[most_components * most_components] = {}, value[most_components] = {};
    };
    enum class Kind { joint, spring, contact };
    struct Connection {
        Kind kind = Kind::joint;
        int index = 0;  // index among the connections of its kind
    };
    void link_all();
    // share of the true inertia that acts in this step
    double inertia() const { return stage_.quasi_static ? std::max(drag * length_ / 2, least_inertia) : 1; }
    bool is(size_t link, Kind kind) const { return connections_[link].kind == kind; }
    double mobility(size_t link, const Row& row) const;
    // contact_step.cpp
    size_t contact_rows() const { return static_cast<size_t>(start(connections_.size() - contacts_.size())); }
    void allow_closing(double h);
    bool settle();
    void stop_reversing(size_t link);
    void commit_contacts(State& s, double h);
    void push_obstacles(State& s, double h);
    double overlap(size_t link) const;
    void see_contacts(State& s, double h);
    void predict(const State& s, double h, const std::vector<Twist>& end);
    void set_free(const State& s);
    void set_mobilities(const std::vector<Pose>& poses);
    void locate_all(const State& s, const std::vector<Pose>& poses, double t, std::vector<Row>& rows, double* error);
    void locate_spring(const Spring& spring, const std::vector<Pose>& poses, Row& row, double* length) const;
    Target target(const Joint& joint, const State& s, double t) const;
    void aim(const State& s, double h);
    void hold_rows();
    void find_redundant(const std::vector<Pose>& poses);
    void project_middle(const State& s, double t);
    void rates(const std::vector<Row>& rows, const Twist* v, double* out) const;
    void freeze(const State& s, double h);
    // passes.cpp
    bool turned_back();
    void keep_locked();
    // follow.cpp
    void keep_pass(bool settled);
    bool follow_pass();
    // newton.cpp
    bool newton();
    bool narrow_ramps();
    int newton_steps() const;
    void tangent_of(size_t link, double* offset, double* tangent) const;
    bool descend(int limit, bool full_steps);
    void linearise(size_t link);
    void solve_once();
    bool balanced(double& slope);
    void take_full_step();
    void seen_rate(size_t link, const double* w, double* seen) const;
    void scale_rate(size_t link, double factor, double* w) const;
    bool reverses(size_t link);
    double search(double slope_end);
    void widen(double width, bool& narrowest);
    void respond(size_t link, const double* w, double* impulse, double* tangent) const;
    double load(size_t link, const double* w) const;
    // central_path.cpp
    bool follow_path(bool together);
    double enter_path(bool warm);
    double step_on_path(bool together, double& least);
    void leave_path();
    // end_of_step.cpp
    bool commit(State& s, double h);
    void work_on_links(State& s, double h);
    void turn_hinges(State& s);
    void work_of_loads(State& s, double h);
    bool project_positions(State& s, double h);
    bool meets() const;
    void project_rates(State& s, double h);
    void show_forces(State& s, double h);
    bool drives_obstacle(size_t joint) const;
    double inertial_energy(size_t body) const;
    double stand_in_energy(size_t joint) const;
    int start(size_t link) const { return system_.start(link); }
    double least_width(const SpatialHinge& hinge) const { return std::max(ramp_width(hinge), narrowest_ramp_); }
    const SpatialHinge* hinge_of(size_t link) const;
    int hinge_index(size_t link) const { return model_.joints[static_cast<size_t>(connections_[link].index)].hinge; }

    const Model& model_;
    Stage stage_;
    Contacts contacts_;
    System system_;
    Loops loops_;
    std::vector<Connection> connections_;    // contacts come last
    std::vector<size_t> hinge_link_;         // link of every hinge
    std::vector<int> component_;             // first component of every hinge in State::rotation
    std::vector<FrozenSpatialHinge> frozen_;   // per hinge
    std::vector<char> turned_back_;          // per hinge: whether it reversed in a pass over the present step
    std::vector<double> spring_force_, spring_tangent_;  // impulse at zero rate, and its slope
    std::vector<double> spring_weight_;      // weight of the end rate in the damper
    std::vector<Tangent> tangent_;           // per link
    std::vector<Pose> middle_, end_;
    std::vector<Twist> free_, velocity_, next_, direction_, momentum_, guess_;
    std::vector<Mat3> inertia_;              // in world axes, at the poses where the mobilities were last set
    std::vector<Row> rows_;                  // at the middle
    std::vector<JointGeometry> geometry_;    // per joint, as last located
    std::vector<double> error_;              // per row, as last located
    std::vector<double> rate0_, bias_, target_;  // per row: true start rate, c, target rate at the end
    std::vector<double> w_, w_next_;         // per row: rates at the end at which the laws are linearised, and the solution
    std::vector<double> impulse_, x_, work_, overload_, worst_near_;
    bool all_set_valued_ = true;
    int redundant_ = 0;
    std::vector<int> redundant_rows_;
    double speed_ = 0;                       // reference value of rates
    double length_ = 0;                      // length of the step [s]
    double narrowest_ramp_ = 0;
    bool solved_ = false;                    // whether w_ holds the solution of the last pass
    int stuck_body_ = -1;
    double tolerance_ = 0;                   // relative tolerance of impulses at the present width of the ramps
    double unbounded_ = 0;                   // in an impact: rate of approach that is never reached; 0 in other steps
    std::vector<double> allowed_;            // allowed normal rate per contact in this pass
    double energy_ = 0;                      // kinetic energy of the free motion [J]
    std::int64_t solves_ = 0, last_solve_ = 0;  // number of solves, and the number at which the present step is abandoned
    bool full_steps_ = true;                       // full Newton steps have not cycled in this step
    bool has_paths_ = false;                 // whether all hinges are rigid and have smooth surfaces
    std::vector<char> on_path_;              // per link: whether it is linearised on the central path
    std::vector<CentralPoint> point_, next_point_, kept_point_;  // per hinge
    std::vector<double> share_;              // per hinge: share of the step to the next point
    double mu_ = 0, kept_mu_ = 0;            // mu of the present and of the kept points [rad/s]; 0: none kept
    std::vector<Pass>* kept_ = nullptr;
    const std::vector<Pass>* followed_ = nullptr;
    size_t next_pass_ = 0;                   // index of the next pass to follow
};

}  // namespace crumple::spatial
