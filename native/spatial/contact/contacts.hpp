// All contacts of a model during a step: points of contact, their rows, and their state.
//
// Candidates are the pairs of a solid (an obstacle, or another capsule) and a capsule; boxes with a margin keep those that
// can meet soon.  Every point of contact within reach of the step is a link of three rows (normal, two tangents) between
// the solid's body and the capsule's.  What overlaps when it first appears (at the start, or with a new stage) is taken
// as it stands: its gap counts from there, and it may not come closer.
#pragma once

#include <cstdint>
#include <vector>

#include "spatial/contact/contact.hpp"
#include "spatial/model/joint.hpp"

namespace crumple::spatial {

using std::size_t;

// Segment with a radius on a body; ends from its centre, in its frame.
struct Capsule {
    int body = 0;
    Segment segment;
};

// Solid on a body (-1: the ground), from its centre, in its frame.
struct Obstacle {
    int body = -1;
    Solid solid;
    ContactLaw law;
    std::vector<int> capsules;  // those that may touch it
};

struct CapsulePair {
    int first, second;
};

struct ContactModel {
    std::vector<Capsule> capsules;
    std::vector<Obstacle> obstacles;
    std::vector<CapsulePair> pairs;  // capsules that may touch one another
    ContactLaw between;              // of capsules
    bool empty() const { return obstacles.empty() && pairs.empty(); }
};

// State of the contacts of a run.
struct ContactState {
    struct Held {
        int64_t key;
        double force;  // normal, mean over the last step [N]
    };
    std::vector<Held> held;               // in the order of their keys
    double dissipated = 0, friction = 0;  // [J]
    std::vector<Vec3> impulse, force;     // on every obstacle: since the start [N s]; mean over the last step [N]
    bool impact = false;                  // a closed contact is being approached: the next step is an impact, as short as possible
    double closing = 0;                   // after a step: when its first open contact closed, from its start; 0 if none did
};

// Friction works against a normal impulse that the step has not found yet: it is taken from the pass before, and
// passes are repeated until it changes by less than this share of the largest.
constexpr double settled_change = 1e-6;

class Contacts {
public:
    explicit Contacts(const ContactModel& model);

    // a stage begins: obstacles that are present, and poses
    void begin(const std::vector<bool>& present, const std::vector<Pose>& pose);
    // the points of contact within reach of a step of length h, in which bodies gain `gain` [m/s] of speed or so; true if
    // they are others than before
    bool gather(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain,
                const ContactState& state);
    size_t size() const { return active_.size(); }
    const int* bodies(size_t i) const { return active_[i].body; }
    // three rows and the gap at other poses
    void locate(size_t i, const std::vector<Pose>& pose, Row* rows, double* gap) const;
    // Rate, along the normal, that a step of length h allows from the rates at its start.  `unbounded`: in an impact, a rate
    // that nothing reaches, for contacts that bounce but are not run into: what they get is the next impact.  0 for none.
    double allowed(size_t i, double h, double start_rate, double unbounded) const;
    void freeze(size_t i, double inverse_mass);
    FrozenContact& frozen(size_t i) { return active_[i].frozen; }
    const FrozenContact& frozen(size_t i) const { return active_[i].frozen; }
    // Stores the result of a pass: impulses, rates at start and end (3 each).  False if another pass is needed: friction
    // used other normal impulses, or an impact gained energy and its restitution must be reduced.
    bool settle(const double* impulse, const double* rate0, const double* rate);
    // after the last pass: energies, forces on obstacles, and when open contacts closed (`from_rest`: in some step that
    // starts at rest); rows as in the step
    void commit(double h, bool from_rest, const Row* rows, const double* impulse, const double* rate0, const double* rate,
                ContactState& state) const;
    // force on the obstacle of a contact, from an impulse (3) of a step of length h
    void push(size_t i, double h, const Row* rows, const double* impulse, ContactState& state) const;
    // whether an impact follows from the gaps and rates (3 each, the first counts) at the end of the step
    bool impact_follows(const double* gap, const double* rate) const;
    // whether there is an overlap of points that were not within reach
    bool overlooked(const std::vector<Pose>& pose) const;
    double closed_gap() const { return closed_gap_; }
    // without bounces what is run into stops, whatever its restitution, and contacts at rest act with it
    void set_bounces(bool bounces) { bounces_ = bounces; }

    // gap below which a contact counts as closed [m], and energy of an approach that is not worth an impact [J]
    void set_limits(double closed_gap, double negligible_energy) {
        closed_gap_ = closed_gap;
        negligible_energy_ = negligible_energy;
    }

private:
    struct Pair {
        int obstacle;               // or -1: between capsules
        int solid, capsule;         // capsules
        double offset = 0;          // gap when it first appeared, where that was an overlap
        bool present = true, seen = false;
    };
    struct Active {
        int64_t key;
        size_t pair;
        int body[2];
        double gap, inverse_mass, normal_impulse;
        Vec3 normal, tangent, point;  // at the start of the step
        FrozenContact frozen;
    };

    static bool in_order(const Pair& a, const Pair& b) {
        return a.solid != b.solid ? a.solid < b.solid : a.capsule < b.capsule;
    }
    Solid solid_at(const Pair& pair, const std::vector<Pose>& pose) const;
    const ContactLaw& law(const Active& c) const {
        const int obstacle = pairs_[c.pair].obstacle;
        return obstacle < 0 ? model_.between : model_.obstacles[static_cast<size_t>(obstacle)].law;
    }
    double rest_rate(const Active& c) const;
    void appear(Pair& pair, const std::vector<Pose>& pose);
    double look_ahead(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain);
    void sweep(double margin);
    void find(size_t pair, const std::vector<Pose>& pose, double reach);
    static bool among(const std::vector<Active>& contacts, int64_t key);

    const ContactModel& model_;
    std::vector<Pair> pairs_;              // of obstacles, then of capsules in their order
    size_t obstacle_pairs_ = 0;
    std::vector<Segment> placed_, swept_;  // capsules in the world, now and at the last sweep
    std::vector<size_t> near_;             // pairs of capsules that may meet before the next sweep
    std::vector<int> order_;               // of capsules along x, as of the last sweep
    double margin_ = 0;
    std::vector<Active> active_, before_;
    double closed_gap_ = 1e-6, negligible_energy_ = 0, restitution_share_ = 1;
    bool bounces_ = true;
};

}  // namespace crumple::spatial
