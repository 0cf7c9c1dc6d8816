// Node-to-element contact.
//
// A node keeps the distance `gap` (half of both thicknesses) from every element except its neighbourhood in the sheet: the connected
// elements within twice the gap at the start.  Elements may therefore be smaller than the wall thickness.  A node has contact with the
// closest element and with the closest one on its other side, so that a wall between two walls is held by both.
// Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/closest_point.hpp"
#include "shell/run/saved.hpp"
#include "shell/contact/contact_search.hpp"
#include "shell/contact/node_forces.hpp"

namespace crumple::shell {

class WallContact {
public:
    // Size of the neighbourhood in the sheet relative to the gap: 2 still detects a fold of inner radius half a thickness (its points
    // in contact were pi/2 thicknesses apart) and keeps compressed flat walls free of contact.
    static constexpr double neighbourhood = 2.0;

    explicit WallContact(const Sheets& sheets);

    double reach() const { return reach_; }      // largest gap [m]
    // Numbers of nodes with candidates and of nodes with close candidates.
    std::size_t items() const { return listed_.size(); }
    std::size_t close_items() const { return close_nodes_.size(); }
    // Forces on a node; `evaluate_all` checks all its candidates and marks those closer than the gap plus `margin`.
    void evaluate_all(const Motions& m, std::size_t item, double margin, FoundForces& found);
    void evaluate_close(const Motions& m, std::size_t item, FoundForces& found);
    // Lists the candidates marked as close.
    void list_close();
    // Stages of a search: `start_search` by one member, `search` by each for its share of the elements, `end_search` by one.
    void start_search(const Motions& m, double skin, int members);
    void search(const Motions& m, const std::vector<std::uint8_t>& alive, Range elements, const Member& member);
    void end_search();
    // Whether an element belongs to the node's own piece of sheet or overlapped with the node at the start.
    bool neighbour(Index node, Index element) const;

    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    struct Candidate {
        Index element;
        std::int8_t side;            // side of the element on which the node is held, +1 or -1; 0: node not over the element
    };
    struct Hit {
        Closest at;
        Vec3 direction;
        double gap, depth;
        Index element;
    };
    struct Near {
        Index node, element;
        std::int8_t side;
    };
    void list_neighbours();
    double gap(Index node, Index element) const;
    std::int8_t side_so_far(Index node, Index element) const;
    struct Hits;
    double approach(const Motions& m, Index node, Candidate& c, double margin, Hits& hits) const;
    void answer(const Motions& m, Index node, const Hits& hits, FoundForces& found);
    void touch(const Motions& m, Index node, const Hit& hit, Vec3& stick, FoundForces& found) const;

    const Sheets& sheets_;
    double reach_ = 0.0, span_ = 0.0;            // span: mean size of elements at the start [m]
    std::vector<Index> neighbour_first_, neighbours_;
    std::vector<Index> listed_;                  // nodes with candidates
    std::vector<std::size_t> candidate_first_{0};
    std::vector<Candidate> candidates_;
    std::vector<Vec3> stick_;                    // friction forces, two for each node; zero unless listed
    std::vector<std::uint8_t> is_close_;         // [candidate]
    std::vector<Index> close_nodes_;             // nodes with close candidates
    std::vector<std::size_t> close_first_{0}, close_;    // CSR: indices of their close candidates
    // data of a search
    PointGrid grid_;
    double far_ = 0.0;
    std::vector<std::vector<Near>> near_;        // [member]
};

}  // namespace crumple::shell
