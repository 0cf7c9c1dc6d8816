// All contacts of a model during a step: points of contact, their rows, and their state.
//
// Candidates are pairs of a solid (an obstacle or another capsule) and a capsule; bounding boxes with a margin select the pairs that
// can meet soon.  Every point of contact within the search distance of the step is a link of three rows (normal, two tangents; without
// friction in the model the normal alone) between the bodies of the solid and the capsule.  A pair that overlaps when it first appears (at the start, or with a new stage) is accepted
// as it is: its gap is measured from there, and it may not come closer.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "spatial/contact/contact.hpp"
#include "spatial/contact/fold_friction.hpp"
#include "spatial/model/joint.hpp"

namespace crumple::spatial {

using std::size_t;

// Segment with a radius on a body; ends relative to the body's centre, in its frame.
struct Capsule {
    int body = 0;
    Segment segment;
    double crush_force = INFINITY;  // at which its wall crushes under a contact [N]; infinite: rigid
    Fold folds[2];                  // at its first and second end
};

// Solid on a body (-1: the ground), relative to the body's centre, in its frame.
struct Obstacle {
    int body = -1;
    Solid solid;
    ContactLaw law;
    std::vector<int> capsules;  // capsules that can have contact with it
    std::vector<int> ends;      // ends of each that it meets: bits of the slots 0 and 1 of touches
};

constexpr int both_ends = 3;

struct CapsulePair {
    int first, second;
};

struct ContactModel {
    std::vector<Capsule> capsules;
    std::vector<Obstacle> obstacles;
    std::vector<CapsulePair> pairs;  // capsules that can have contact with each other
    ContactLaw between;              // contact law between capsules
    bool empty() const { return obstacles.empty() && pairs.empty(); }
};

// State of the contacts of a run.
struct ContactState {
    struct Held {
        int64_t key;
        double force;  // normal force, mean over the last step [N]
    };
    std::vector<Held> held;               // contacts that carry a force, in the order of their keys
    double dissipated = 0, friction = 0;  // [J]
    std::vector<Vec3> impulse, force;     // on every obstacle: since the start [N s]; mean over the last step [N]
    bool impact = false;                  // bodies approach at a closed contact: the next step is an impact, of the smallest length
    std::vector<double> crushed;          // depth to which walls are crushed [m], two of each pair; empty while none is
    double closing = 0;                   // after a step: time from its start at which its first open contact closed; 0 if none did

    // The forces to start from in the halves of a step, from the state after the whole: in the first half the same, ...
    void expect_first_half(const ContactState& whole) { held = whole.held; }
    // ... and in the second as much beyond them as they are beyond those of the first half.
    void expect_second_half(const ContactState& whole) {
        auto mean = whole.held.begin();
        for (Held& one : held) {
            while (mean != whole.held.end() && mean->key < one.key) ++mean;
            if (mean != whole.held.end() && mean->key == one.key) one.force = std::max(2 * mean->force - one.force, 0.0);
        }
    }
};

class Contacts {
public:
    explicit Contacts(const ContactModel& model);

    // begins a stage with the obstacles that are present, at these poses
    void begin(const std::vector<bool>& present, const std::vector<Pose>& pose);
    // Finds the points of contact within the search distance of a step of length h, in which bodies gain about `gain` [m/s] of speed;
    // true if they differ from those before.
    bool gather(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain,
                const ContactState& state);
    size_t size() const { return active_.size(); }
    // rows of every contact
    size_t rows() const { return rows_; }
    const int* bodies(size_t i) const { return active_[i].body; }
    // rows and the gap at other poses
    void locate(size_t i, const std::vector<Pose>& pose, Row* out, double* gap) const;
    // Normal rate that a step of length h allows, from the rate at its start.  `unbounded`: in an impact, a rate that is never reached,
    // for contacts with restitution that bodies do not approach now: their impact follows next; 0 in other steps.
    double allowed(size_t i, double h, double start_rate, double unbounded) const;
    void freeze(size_t i, double inverse_mass, double h);
    // sets the half-width of its ramps [m/s]: of friction, and of the approach at which its walls crush; at least the smallest one
    void widen(size_t i, double width);
    const FrozenContact& frozen(size_t i) const { return active_[i].frozen; }
    // Friction limits mu N use normal impulses N of their own: whether they are those that were found (impulses, `rows` each), to a
    // share `set_settled` of the largest, wherever a point slides; and sets N.
    bool limits_hold(const double* impulse) const;
    void set_normal(size_t i, double impulse);
    double normal(size_t i) const { return active_[i].normal_impulse; }
    double friction(size_t i) const { return law(active_[i]).friction; }
    // Stores the result of a pass: impulses and rates at the start and end (`rows` each).  False if another pass is needed: the normal
    // impulses used for friction have changed, unless `any_limits` will do, or an impact gained energy and its restitution must be reduced.
    bool settle(const double* impulse, const double* rate0, const double* rate, bool any_limits);
    // after the last pass: energies, forces on obstacles, and the time at which open contacts closed (`from_rest`: the step starts at
    // rest); rows as in the step
    void commit(double h, bool from_rest, const Row* at_middle, const double* impulse, const double* rate0, const double* rate,
                ContactState& state) const;
    // adds an impulse (`rows`) of a step of length h to the force on the obstacle of a contact
    void push(size_t i, double h, const Row* at_middle, const double* impulse, ContactState& state) const;
    // whether an impact follows, from the gaps and rates (`rows` each, only the first is used) at the end of the step
    bool impact_follows(const double* gap, const double* rate) const;
    // whether points overlap that were not within the search distance
    bool overlooked(const std::vector<Pose>& pose, const ContactState& state) const;
    // whether a contact has ramps that are to be widened: of friction, or of walls that crush
    bool ramps(size_t i) const { return rows_ == 3 || crushes(i); }
    // whether the walls of a contact crush: then it has no impacts, and its overlap is not removed
    bool crushes(size_t i) const { return std::isfinite(crush_force(pairs_[active_[i].pair])); }
    // walls of points that overlap by these gaps (`rows` each, the first is used) are crushed by as much
    void crush(const double* gap, ContactState& state) const;
    // obstacle (-1: none), capsules (the first -1 with an obstacle), and depth [m] of every crushed pair
    struct Crushed {
        int obstacle, first, second;
        double depth;
    };
    std::vector<Crushed> crushed(const ContactState& state) const;
    double closed_gap() const { return closed_gap_; }
    // without bounces every impact has zero restitution, and contacts at rest act together with it
    void set_bounces(bool bounces) { bounces_ = bounces; }

    // share of the largest normal impulse up to which the normal impulses used for friction may differ from those found
    void set_settled(double change) { settled_change_ = change; }
    // gap below which a contact counts as closed [m], and energy of an approach below which it is not treated as an impact [J]
    void set_limits(double closed_gap, double negligible_energy) {
        closed_gap_ = closed_gap;
        negligible_energy_ = negligible_energy;
    }

private:
    struct Pair {
        int obstacle;               // -1: contact between two capsules
        int solid, capsule;         // indices of capsules
        int ends = both_ends;       // of the capsule that the obstacle meets
        bool curved = false;        // a ball, a pole or an edge, which may strike a capsule anywhere
        double offset = 0;          // initial gap if the pair overlapped when it first appeared
        bool present = true, seen = false;
    };
    struct Active {
        int64_t key;
        size_t pair;
        int body[2];
        double gap, inverse_mass, normal_impulse, offset;
        Vec3 normal, tangent, point;  // at the start of the step
        FrozenContact frozen;
    };

    static bool meets_face(const Pair& pair) { return pair.obstacle >= 0 && !pair.curved; }
    static bool in_order(const Pair& a, const Pair& b) {
        return a.solid != b.solid ? a.solid < b.solid : a.capsule < b.capsule;
    }
    Solid solid_at(const Pair& pair, const std::vector<Pose>& pose) const;
    int points(const Pair& pair, const Solid& solid, const Segment& segment, Touch* touch) const;
    const ContactLaw& law(const Active& c) const {
        const int obstacle = pairs_[c.pair].obstacle;
        return obstacle < 0 ? model_.between : model_.obstacles[static_cast<size_t>(obstacle)].law;
    }
    double rest_rate(const Active& c) const;
    double crush_force(const Pair& pair) const;
    // Index of the depth to which walls are crushed at a point.  A face crushes each end on its own; what is curved wanders along the
    // capsule, so that points of different kinds share a depth.
    size_t wall(size_t pair, int slot) const { return 2 * pair + (meets_face(pairs_[pair]) && slot == 1 ? 1 : 0); }
    // gap of the undeformed surfaces at which a point of a pair is in contact, and the largest of its points
    double offset(size_t pair, int slot, const ContactState& state) const {
        return pairs_[pair].offset - (state.crushed.empty() ? 0 : state.crushed[wall(pair, slot)]);
    }
    double largest_offset(size_t pair, const ContactState& state) const {
        return std::max(offset(pair, 0, state), offset(pair, 1, state));
    }
    void appear(Pair& pair, const std::vector<Pose>& pose);
    double look_ahead(const std::vector<Pose>& pose, const std::vector<Twist>& velocity, double h, double gain);
    void sweep(double margin);
    void find(size_t pair, const std::vector<Pose>& pose, double reach, const ContactState& state);
    static bool among(const std::vector<Active>& contacts, int64_t key);

    const ContactModel& model_;
    std::vector<Pair> pairs_;              // pairs with obstacles, then pairs of capsules in their order
    size_t obstacle_pairs_ = 0;
    std::vector<Segment> placed_, swept_;  // capsules in world axes, now and at the last sweep
    std::vector<size_t> near_;             // pairs of capsules that may meet before the next sweep
    std::vector<int> order_;               // capsules sorted along x at the last sweep
    double margin_ = 0;
    std::vector<Active> active_, before_;
    double closed_gap_ = 1e-6, negligible_energy_ = 0, restitution_share_ = 1, settled_change_ = 1e-6;
    bool bounces_ = true;
    size_t rows_ = 3;
};

}  // namespace crumple::spatial
