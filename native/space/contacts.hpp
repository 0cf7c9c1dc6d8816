// All contacts of a model over a step: which there are, their rows, and what they remember.
//
// Candidates are the pairs of a solid (an obstacle, or another capsule) and a capsule; boxes with a margin keep those that can
// meet soon.  Every point of contact within reach of the step is a link of three rows (normal, two tangents) between
// the solid's body and the capsule's.  What overlaps when it first appears (at the start, or with a new stage) is
// taken as it stands: its gap counts from there, and it may not come closer.
#pragma once

#include <cstdint>
#include <vector>

#include "space/contact.hpp"
#include "space/system.hpp"

namespace crumple::space {

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
    int solid, capsule;
};

struct ContactModel {
    std::vector<Capsule> capsules;
    std::vector<Obstacle> obstacles;
    std::vector<CapsulePair> pairs;  // capsules that may touch one another
    ContactLaw between;              // of capsules
    bool empty() const { return capsules.empty() || (obstacles.empty() && pairs.empty()); }
};

// What a run remembers of its contacts.
struct ContactState {
    struct Held {
        int64_t key;
        double force;  // normal, mean over the last step [N]
    };
    std::vector<Held> held;             // in the order of their keys
    double dissipated = 0, friction = 0;  // [J]
    std::vector<Vec3> impulse;          // on every obstacle since the start of the run [N s]
    std::vector<Vec3> force;            // on every obstacle, mean over the last step [N]
};

// Friction works against a normal impulse that the step has not found yet: it is taken from the pass before, and
// passes are repeated until it changes by less than this share.
constexpr double settled_change = 1e-6;

class Contacts {
public:
    explicit Contacts(const ContactModel& model);

    // a stage begins: obstacles that are present, and poses
    void begin(const std::vector<bool>& present, const Pose* pose);
    // the points of contact within reach of a step of length h; true if they are others than before
    bool gather(const Pose* pose, const Twist* velocity, double h, double share, const ContactState& state);
    size_t size() const { return active_.size(); }
    int body(size_t i, int side) const { return active_[i].body[side]; }
    // rows at the middle of the step and biases to its end, for the predicted end velocities
    void place(const Pose* middle, const Pose* end, const Twist* predicted);
    const Row* rows(size_t i) const { return active_[i].row; }
    void freeze(const System& system);
    FrozenContact& frozen(size_t i) { return active_[i].frozen; }
    // takes the impulses (3 each) and end velocities that a pass has found; false if another pass must follow, since
    // friction worked against other normal impulses, or since an impact would gain energy and must bounce less
    bool settle(const double* impulse, const Twist* start, const Twist* end);
    // after the last pass
    void commit(const Twist* start, const Twist* end, ContactState& state);

    // whether something closed is being run into: the next step must be as short as can be
    bool impact() const { return impact_; }
    // when the first open contact of the step just solved closes with an energy that counts, from the step's start; its
    // length if none does
    double first_closing(const Twist* start, const Twist* end) const;
    // deepest overlap at the start of the step
    double overlap() const { return overlap_; }
    double gap(size_t i) const { return active_[i].gap; }

    // gap below which a contact counts as closed [m]
    void set_closed_gap(double gap) { closed_gap_ = gap; }
    // energy of an approach that is not worth an impact [J]
    void set_negligible_energy(double energy) { negligible_energy_ = energy; }

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
        double gap, rate;           // at the start of the step
        double inverse_mass;
        Vec3 normal, point;         // as last placed
        Row row[3];
        Vec3 bias;
        double normal_impulse;
        double impulse[3];
        FrozenContact frozen;
    };

    static bool in_order(const Pair& a, const Pair& b) {
        return a.solid != b.solid ? a.solid < b.solid : a.capsule < b.capsule;
    }
    Solid solid_at(const Pair& pair, const Pose* pose) const;
    const ContactLaw& law(const Pair& pair) const {
        return pair.obstacle < 0 ? model_.between : model_.obstacles[static_cast<size_t>(pair.obstacle)].law;
    }
    void appear(Pair& pair, const Pose* pose);
    double look_ahead(const Pose* pose, const Twist* velocity, double h);
    void sweep(double margin);
    void find(size_t pair, const Pose* pose, const Twist* velocity, double reach);
    bool aim(Active& contact, const Pose* pose) const;
    void rates(const Active& contact, const Twist* v, double* w) const;

    const ContactModel& model_;
    std::vector<Pair> pairs_;              // of obstacles, then of capsules in their order
    size_t obstacle_pairs_ = 0;
    std::vector<Segment> placed_, swept_;  // capsules in the world, now and at the last sweep
    std::vector<size_t> near_;             // pairs of capsules that may meet before the next sweep
    std::vector<int> order_;               // of capsules along x, as of the last sweep
    double margin_ = 0;
    std::vector<Active> active_, before_;
    double h_ = 0, share_ = 0.5;
    double closed_gap_ = 1e-6, negligible_energy_ = 0, overlap_ = 0, restitution_share_ = 1;
    bool impact_ = false;
};

}  // namespace crumple::space
