// The problem of a step: links with their rows, laws frozen for the step, and the solution found so far.
//
// It is formulated in step/stepper.hpp.  The parts that solve it have a state of their own and share this one: the stages of a step set it
// up, Newton's method (newton.hpp) and the central path (central_path.hpp) solve it, and the end of the step (step/end_of_step.hpp) uses
// the solution.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "spatial/model/model.hpp"
#include "spatial/solve/system.hpp"

namespace crumple::spatial {

// Drag coefficient of quasi-static stages per mass [1/s], the only resistance to motion out of equilibrium.  A step begins at rest and
// ends with twice its mean velocity, so the share drag h/2 of the inertia gives the force drag m v for any step length, and motion out
// of equilibrium does not depend on the steps.  Smaller values need more steps if loads rotate with the structure; larger ones become
// noticeable.
constexpr double drag = 0.1;
// Weight of the end of a quasi-static step in the moments of elastic hinges: 2/3 of the error of a moment is left after each step.  A
// step from a state out of balance weights its end alone, which leaves none: such an error does not shrink with the step, so that steps
// would be shortened without limit.
constexpr double still_weight = 0.6, settling_weight = 1;
// Smallest share of the inertia, for very short steps: less would be lost in rounding.
constexpr double least_inertia = 1e-8;

struct Stage {
    bool quasi_static = false;
    std::vector<DriveStage> drives;
    bool settling = false;  // the next steps begin out of balance, as at its start or beside a kink
    bool lost = false;      // there is no balance nearby
};

struct Problem {
    enum class Kind { joint, spring, contact };
    struct Connection {
        Kind kind = Kind::joint;
        int index = 0;  // index among the connections of its kind
    };
    // Linearisation of a law, P = offset + D w, at the rates where it was last evaluated; D by its eigenvectors, and the square roots of its
    // eigenvalues.
    struct Tangent {
        double offset[most_components] = {};
        double vectors[most_components * most_components] = {}, root[most_components] = {};
    };

    explicit Problem(const Model& model);
    // sets the links of joints, springs and present contacts, and resizes the arrays of their rows
    void link_all();
    bool is_joint(size_t link) const { return connections[link].kind == Kind::joint; }
    bool is_spring(size_t link) const { return connections[link].kind == Kind::spring; }
    bool is_contact(size_t link) const { return connections[link].kind == Kind::contact; }
    const SpatialHinge* hinge_of(size_t link) const;
    int hinge_index(size_t link) const { return model.joints[static_cast<size_t>(connections[link].index)].hinge; }
    // first row of a link, and of all contacts
    int start(size_t link) const { return system.start(link); }
    size_t contact_rows() const { return static_cast<size_t>(start(connections.size() - contacts.size())); }
    // share of a change of forces that is followed in a time; in quasi-static stages, and where all vibration is resolved, all of it
    double followed(double time) const { return stage.quasi_static ? 1 : 1 - std::exp(-time * model.resolved_frequency); }
    // weight of the end of a step in what acts in it without inertia
    double end_weight() const { return !stage.quasi_static ? 0.5 : stage.settling ? settling_weight : still_weight; }
    // the same in the moments of elastic hinges in a step of length h, see `hinge::Span`
    double elastic_weight(double h) const;
    // whether a step finds the balance of elastic forces without inertia; out of balance the middle keeps the energy
    bool balances() const { return stage.quasi_static && elastic && !stage.lost; }
    // share of a step after which forces and places are taken: where the elastic ones balance the loads, else its middle
    double balanced_at() const { return balances() ? end_weight() : 0.5; }
    // factor of a load in a step from a state: its mean, in quasi-static stages with the weight of elastic moments
    double factor_of(const Load& load, const State& s, double h) const;
    // share of the true inertia that acts in this step
    double inertia_share() const { return stage.quasi_static ? std::max(drag * length / 2, least_inertia) : 1; }
    // mobility: rate along a row for a unit impulse along it, with both bodies free
    double mobility(size_t link, const Row& row) const;
    void set_mobilities(const std::vector<Pose>& poses);
    // rows of all links at the given poses, with the drives of the state's stage at time t
    void locate_all(const State& s, const std::vector<Pose>& poses, double t, std::vector<Row>& rows, double* error);
    void locate_spring(const Spring& spring, const std::vector<Pose>& poses, Row& row, double* length) const;
    // sets up the system at the rows last located, with the tangents of the laws that were found last
    void assemble();
    // sets up and factorises the system with held rows only, without laws
    void hold_rows();
    void rates(const std::vector<Row>& rows, const Twist* v, double* out) const;
    double displacement(const Drive& drive, size_t index, const State& s, double t) const;
    Target target_of(const Joint& joint, const State& s, double t) const;
    // impulse and tangent of a law; load factor of a hinge: above 1 it must flow
    void respond(size_t link, const double* w, double* impulse, double* tangent) const;
    double load(size_t link, const double* w) const;
    // Rates in a law: a w_0 + (1 - a) w for a coupled hinge that continues to slide, see `FrozenSpatialHinge::lead`; and multiplies them.
    void seen_rate(size_t link, const double* w, double* seen) const;
    void scale_rate(size_t link, double factor, double* w) const;
    double least_width(const SpatialHinge& hinge) const { return std::max(ramp_width(hinge), narrowest_ramp); }

    const Model& model;
    Stage stage;
    Contacts contacts;
    System system;
    std::vector<Connection> connections;     // contacts come last
    std::vector<size_t> hinge_link;          // link of every hinge
    std::vector<int> component;              // first component of every hinge in State::rotation
    std::vector<FrozenSpatialHinge> frozen;  // per hinge
    std::vector<double> spring_force, spring_tangent;  // impulse at zero rate, and its slope
    std::vector<double> spring_weight;       // weight of the end rate in the damper
    std::vector<Pose> middle, end;
    std::vector<Twist> free, velocity;       // V*, and the solution
    std::vector<Mat3> inertia;               // in world axes, at the poses where the mobilities were last set
    std::vector<Row> rows;                   // at the middle; after a step, at its end
    std::vector<JointGeometry> geometry;     // per joint, as last located
    std::vector<double> error;               // per row, as last located
    std::vector<double> rate0, bias, target; // per row: true start rate, c, target rate at the end
    std::vector<double> w, w_next;           // per row: rates at the end at which the laws are linearised, and the solution
    std::vector<double> impulse;             // per row
    std::vector<double> x;                   // per row: the unknowns of the system
    std::vector<Tangent> tangent;            // per link
    double speed = 0;                        // reference value of rates
    double length = 0;                       // length of the step [s]
    double narrowest_ramp = 0;               // smallest half-width of a hinge's ramp [rad/s]
    bool all_set_valued = true, elastic = false;  // forms of the hinges: no other; at least one
};

}  // namespace crumple::spatial
