// Edge-to-edge contact of free edges and creases that can cross between their nodes.
//
// Node-to-element contact covers wall against wall and edge against wall; two edges that cross have no node in contact.  The edges
// considered are free edges (one element), branches (three or more elements) and creases (two elements that now meet at an angle).
// Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/wall_contact.hpp"
#include "shell/run/saved.hpp"

namespace crumple::shell {

class EdgeContact {
public:
    EdgeContact(const Sheets& sheets, const WallContact& walls);

    // Numbers of pairs and of close pairs.
    std::size_t items() const { return pairs_.size(); }
    std::size_t close_items() const { return close_.size(); }
    // Forces of a pair; `evaluate_all` also marks the pair as close if its distance is below its gap plus `margin`.
    void evaluate_all(const Motions& m, std::size_t item, double margin, FoundForces& found);
    void evaluate_close(const Motions& m, std::size_t item, FoundForces& found) { evaluate(m, pairs_[close_[item]], found); }
    // Lists the pairs marked as close.
    void list_close();
    // Stages of a search: `turn` by each member for its share of the elements, `find_creases` by each member for its share of the
    // edges, `start_search` by one member, `search` by each, `end_search` by one.
    void turn(const Motions& m, Range elements);
    void find_creases(const std::vector<std::uint8_t>& alive, const Member& member);
    void start_search(const Motions& m, double skin, int members);
    void search(const Motions& m, const Member& member);
    void end_search(const Motions& m);

    void save(std::vector<double>& out) const;
    void restore(Saved& in);

private:
    struct Edge {
        Index node[2];
        double half;                 // half the thickness there
        std::vector<Index> elements;
        std::vector<std::int8_t> sense;          // +1 if the element traverses the edge from its first node to its second
    };
    struct Pair {
        Index first, second;         // edges
        double gap;                  // distance kept: half of both thicknesses, or less if the pair was closer when it was found
        Vec3 stick;
        bool close;                  // as marked when all pairs were last checked
    };
    void evaluate(const Motions& m, Pair& pair, FoundForces& found) const;
    void list_edges();
    bool stands_out(const std::vector<std::uint8_t>& alive, const Edge& e) const;
    bool same_sheet(const Edge& a, const Edge& b) const;

    const Sheets& sheets_;
    const WallContact& walls_;
    std::vector<Edge> edges_;
    std::vector<Pair> pairs_;        // in order of their edges
    std::vector<std::size_t> close_; // indices of the close pairs
    // data of a search
    std::vector<Vec3> normal_;       // [element] not normalised
    std::vector<std::uint8_t> out_;  // [edge] whether it is a free edge, branch or crease
    std::vector<Index> listed_;      // these edges
    PointGrid middles_;              // their midpoints
    double far_ = 0.0, longest_ = 0.0;
    std::vector<std::vector<Pair>> near_;        // [member]
};

}  // namespace crumple::shell
