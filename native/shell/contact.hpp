// Contact of walls with walls and with rigid planes: penalty forces on nodes.
//
// A node keeps the distance `gap` (half of both thicknesses) from every element but its neighbourhood in
// the sheet: those within twice the gap at the start that hang together with it.  So elements may be
// smaller than the wall is thick.  One record per node: the closest element.  Theory: docs/theory/contact.md.
#pragma once
#include <utility>

#include "closest_point.hpp"
#include "lowering.hpp"

namespace crumple::shell {

// What contact reads of the moving state.
struct Motions {
    const double* position;
    const double* velocity;
};

struct Candidate {
    Index element;
    std::int8_t side;                // side of the element on which the node is held, +1 or -1
};

struct Touch {                       // force on the node; its opposite goes to the corners by weight
    Vec3 force;
    double weight[4];
    Index element;
    double depth;                    // penetration over gap
    bool active;
};

class Contact {
public:
    Contact(const Model& model, const Masses& masses, double step);

    bool any() const { return on_ || !planes_.empty(); }
    // Work items that threads may share; a wall item is a node with candidates.
    std::size_t items() const { return listed_.size() + plane_touch_.size(); }
    void evaluate(const Motions& m, std::size_t first, std::size_t last);
    // Sums the records into forces, in fixed order; accumulates the work done on contact over the last step [J].
    void commit(const Motions& m, double last_dt);
    // Searches anew where nodes have moved far; `alive` tells which elements still exist.
    void search_when_needed(const Motions& m, const std::vector<std::uint8_t>& alive, bool force);

    const double* force() const { return force_.data(); }
    double work() const { return work_; }
    double deepest() const { return deepest_; }
    std::size_t searches() const { return searches_; }
    std::size_t touching() const { return touched_.size(); }

    // What a restart needs besides positions.
    std::vector<double> save() const;
    void restore(const std::vector<double>& saved);

private:
    void list_neighbours();
    void search(const Motions& m, const std::vector<std::uint8_t>& alive);
    bool neighbour(Index node, Index element) const;
    void corners(const double* position, Index element, Vec3 (&x)[4]) const;
    Touch touch_wall(const Motions& m, Index node, std::size_t first, std::size_t last) const;
    Touch touch_plane(const Motions& m, std::size_t item) const;
    void add(Index node, Vec3 force);

    const Model& model_;
    std::vector<double> mass_, half_;            // [node] mass, half the mean thickness of its elements
    double step_, reach_ = 0.0, skin_ = 0.0;     // time step of the penalty, largest gap, margin of the search
    bool on_ = false;
    std::vector<Index> neighbour_first_, neighbours_;
    std::vector<Index> listed_;                  // nodes with candidates
    std::vector<std::size_t> candidate_first_;
    std::vector<Candidate> candidates_;
    std::vector<Touch> wall_touch_, plane_touch_;
    std::vector<Plane> planes_;
    std::vector<std::pair<std::size_t, Index>> plane_item_;   // plane and node
    aligned_vector<double> force_, force_before_;
    std::vector<Index> touched_, touched_before_;
    std::vector<double> searched_at_;            // positions of the last search
    double work_ = 0.0, deepest_ = 0.0;
    std::size_t searches_ = 0, checks_ = 0;
};

// Calls found(node, element) for each pair of boxes closer than `reach`; nodes in order, elements in order of cells.
using PairList = std::vector<std::pair<Index, Index>>;
PairList close_pairs(const double* position, int stride, std::size_t nodes, const std::vector<Index>& quads,
                     const std::vector<std::uint8_t>& alive, double reach);

}  // namespace crumple::shell
