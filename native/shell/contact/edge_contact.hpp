// Edges against edges: rims of the sheet and creases, where two can cross between their nodes.
//
// Nodes against elements hold a wall against a wall and an edge against a wall; two edges that cross
// have no node in contact.  An edge is a rim (one element), a branch (three and more) or a crease: its
// elements now at an angle.  Theory: docs/theory/contact.md.
#pragma once
#include "shell/contact/wall_contact.hpp"
#include "shell/run/saved.hpp"

namespace crumple::shell {

class EdgeContact {
public:
    EdgeContact(const Sheets& sheets, const WallContact& walls);

    // Pairs, and those that are close.
    std::size_t items() const { return pairs_.size(); }
    std::size_t close_items() const { return close_.size(); }
    // Forces of the pair of an item; the first notes whether it is nearer than its gap and `margin`.
    void evaluate_all(const Motions& m, std::size_t item, double margin, FoundForces& found);
    void evaluate_close(const Motions& m, std::size_t item, FoundForces& found) { evaluate(m, pairs_[close_[item]], found); }
    // Lists what was noted as close.
    void list_close();
    // Parts of a search: each member with its share of the elements, then of the edges; one alone; each; one alone.
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
        std::vector<std::int8_t> sense;          // +1 where the element runs along the edge from first to second
    };
    struct Pair {
        Index first, second;         // edges
        double gap;                  // distance kept: that of the walls, or what it was when the pair was found
        Vec3 stick;
        bool close;                  // noted by the last look at all
    };
    void evaluate(const Motions& m, Pair& pair, FoundForces& found) const;
    void list_edges();
    bool stands_out(const std::vector<std::uint8_t>& alive, const Edge& e) const;
    bool same_sheet(const Edge& a, const Edge& b) const;

    const Sheets& sheets_;
    const WallContact& walls_;
    std::vector<Edge> edges_;
    std::vector<Pair> pairs_;        // in order of their edges
    std::vector<std::size_t> close_; // places of close ones among them
    // of a search
    std::vector<Vec3> normal_;       // [element] not of unit length
    std::vector<std::uint8_t> out_;  // [edge] whether it stands out
    std::vector<Index> listed_;      // edges that do
    PointGrid middles_;              // of those
    double far_ = 0.0, longest_ = 0.0;
    std::vector<std::vector<Pair>> near_;        // [member]
};

}  // namespace crumple::shell
