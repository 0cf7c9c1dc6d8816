// Contact of nodes with rigid planes, cylinders and spheres that are fixed, driven, or have a mass on a linear guide.
//
// A point X of an obstacle is at x = c + Q (X + u - c): displaced by u, then rotated about the fixed axis through c.
// A node keeps a distance of half its wall's thickness, or its distance at the time the obstacle appears if that is smaller: the end
// of a wall that stands on a plane has no thickness towards it.  Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/body_contact.hpp"
#include "shell/run/saved.hpp"
#include "shell/contact/node_forces.hpp"

namespace crumple::shell {

// Distance of a point from a solid [m], negative inside, and the outward unit normal.
struct Distance {
    double value;
    Vec3 normal;
};
Distance distance_from(const Obstacle& o, Vec3 x);

class ObstacleContact {
public:
    struct State {
        Vec3 shift, velocity;        // u at the step [m], its rate half a step earlier [m/s]
        double angle = 0.0, rate = 0.0;
        Vec3 force, moment;          // of the structure on the obstacle, moment about c
        Vec3 force_before, moment_before;
        Vec3 impulse;                // of the structure on the obstacle so far [N s]
        double deepest = 0.0;        // largest penetration so far relative to half the wall's thickness
        double inside = 0.0;         // depth of the deepest node when the obstacle appeared in this model [m]
        Index inside_node = 0;
    };

    explicit ObstacleContact(const Sheets& sheets);
    // Sets the rigid bodies; the contacts of each body are solved together.  They must outlive this object.  Nodes of a body without
    // elements touch like the mean of its nodes with elements.
    void attach(const std::vector<RigidBody>& bodies, const std::vector<RigidState>& states);

    bool any() const { return !model_.empty(); }
    std::size_t items() const { return items_.size(); }
    const std::vector<State>& states() const { return states_; }
    // Moves the obstacles by one step: velocities over `kick`, positions over `drift` [s].
    void move(double time, double kick, double drift);
    void evaluate(const Motions& m, std::size_t item);
    // Adds the forces in a fixed order; returns the largest penetration relative to half the wall's thickness.
    double commit(const Motions& m, NodeForces& forces);
    // Adds the work on driven obstacles and of gravity over the last step [J], by the mean of the forces at its start and end.
    void book(double last_step);
    double power(bool before) const;                     // of the structure on the obstacles, at the start or end of the step [W]
    double kinetic(double kick) const;                   // [J]
    double external_work() const { return outside_work_; }
    // Places obstacles that have just appeared relative to the present walls.
    void place(const Motions& m);
    // Stops all masses; returns the lost kinetic energy [J].
    double stop();
    // Largest displacement of any obstacle since the last search [m].
    double moved() const;
    void search(const Motions& m, double skin);

    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    struct Item {
        std::uint32_t obstacle, place;   // place: index in the obstacle's list of nodes
    };
    struct Touch {
        Vec3 force, moment;          // on the node; moment about the obstacle's c
        double depth;                // [m]
        bool active;
        Vec3 normal, slip;           // out of the obstacle; velocity relative to its surface [m/s]
    };
    std::vector<std::vector<BodyTouch>> touches_of_bodies(const Motions& m) const;
    void hold_bodies(const Motions& m);
    // rigid set of a contact's node; the last one for fixed nodes on an obstacle with a mass, and -1 for other nodes
    int set_of(const Item& item) const;
    Vec3 in_frame(std::size_t o, Vec3 x) const;
    double acceleration(std::size_t o) const;            // of an obstacle with mass along its guide [m/s2]

    const Sheets& sheets_;
    const std::vector<Obstacle>& model_;
    std::vector<State> states_;
    std::vector<Mat3> turn_;                             // Q of each obstacle
    std::vector<double> soft_;                           // factor on the penalty stiffness for an obstacle of small mass
    std::vector<std::uint8_t> present_;                  // placed, or active at the last checkpoint
    std::vector<std::vector<double>> gap_;               // [obstacle][node of its list] distance kept [m]
    std::vector<std::vector<Vec3>> stick_;
    std::vector<Vec3> searched_at_;
    const std::vector<RigidBody>* bodies_ = nullptr;
    const std::vector<RigidState>* body_states_ = nullptr;
    RigidBody ground_;                                   // all fixed nodes: what gives way is the obstacle alone
    std::vector<std::int32_t> body_of_;                  // [node] rigid set, -1: none
    std::vector<double> mass_, half_;                    // [node] as in the sheets, and for nodes of rigid sets without elements
    std::vector<Item> items_;
    std::vector<Touch> touch_;
    double outside_work_ = 0.0;
};

}  // namespace crumple::shell
