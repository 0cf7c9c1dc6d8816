// Nodes against rigid planes, cylinders and spheres that are fixed, driven, or have a mass on a guide.
//
// A point X of an obstacle is at x = c + Q (X + u - c): moved by u, then turned about the fixed axis through c.
// A node keeps half its wall's thickness away, or the distance it has when the obstacle appears if that is less:
// the end of a wall that stands on a plane has no thickness towards it.  Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/body_contact.hpp"
#include "shell/run/saved.hpp"
#include "shell/contact/node_forces.hpp"

namespace crumple::shell {

// How far a point is outside a solid [m], negative inside, and the unit normal out of it.
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
        Vec3 force, moment;          // of the structure on it, moment about c
        Vec3 force_before, moment_before;
        Vec3 impulse;                // of the structure on it so far [N s]
        double deepest = 0.0;        // penetration so far over half the wall's thickness
        double inside = 0.0;         // depth of the deepest node when it appeared in this model [m]
        Index inside_node = 0;
    };

    explicit ObstacleContact(const Sheets& sheets);
    // Sets the rigid bodies, whose contacts are resolved together; they must outlive this object.
    void attach(const std::vector<RigidBody>& bodies, const std::vector<RigidState>& states);

    bool any() const { return !model_.empty(); }
    std::size_t items() const { return items_.size(); }
    const std::vector<State>& states() const { return states_; }
    // Moves them by one step: velocities over `kick`, places over `drift` [s].
    void move(double time, double kick, double drift);
    void evaluate(const Motions& m, std::size_t item);
    // Adds forces in fixed order; gives the deepest penetration over half the wall's thickness.
    double commit(const Motions& m, NodeForces& forces);
    // Work on driven ones and of gravity over the last step [J], by the mean of the forces at both ends.
    void book(double last_step);
    double power(bool before) const;                     // of the structure on them, at either end of the step [W]
    double kinetic(double kick) const;                   // [J]
    double external_work() const { return outside_work_; }
    // Sets those that have just appeared beside the walls as they are now.
    void place(const Motions& m);
    // Ends all motion of masses; gives the kinetic energy that was lost [J].
    double stop();
    // Largest way of any obstacle since the last search [m].
    double moved() const;
    void search(const Motions& m, double skin);

    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    struct Item {
        std::uint32_t obstacle, place;   // place in the obstacle's list of nodes
    };
    struct Touch {
        Vec3 force, moment;          // on the node; moment about the obstacle's c
        double depth;                // [m]
        bool active;
        Vec3 normal, slip;           // out of the obstacle; velocity against its surface [m/s]
    };
    void hold_bodies(const Motions& m);
    Vec3 in_frame(std::size_t o, Vec3 x) const;
    double acceleration(std::size_t o) const;            // of a mass along its guide [m/s2]

    const Sheets& sheets_;
    const std::vector<Obstacle>& model_;
    std::vector<State> states_;
    std::vector<Mat3> turn_;                             // Q of each
    std::vector<double> soft_;                           // factor on the penalty for the sake of a light mass
    std::vector<std::uint8_t> present_;                  // placed, or there at the last checkpoint
    std::vector<std::vector<double>> gap_;               // [obstacle][node of its list]
    std::vector<std::vector<Vec3>> stick_;
    std::vector<Vec3> searched_at_;
    const std::vector<RigidBody>* bodies_ = nullptr;
    const std::vector<RigidState>* body_states_ = nullptr;
    std::vector<std::int32_t> body_of_;                  // [node] rigid set, -1: none
    std::vector<Item> items_;
    std::vector<Touch> touch_;
    double outside_work_ = 0.0;
};

}  // namespace crumple::shell
