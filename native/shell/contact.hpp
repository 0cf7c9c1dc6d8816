// Contact of walls with walls, edges with edges, and nodes with obstacles: penalty forces on nodes.
// Theory: docs/theory/contact.md.
#pragma once
#include <memory>

#include "edge_contact.hpp"
#include "obstacles.hpp"

namespace crumple::shell {

class Contact {
public:
    Contact(const Model& model, const Masses& masses, double step);

    bool any() const { return walls_ || obstacles_.any(); }
    // Work items that threads may share.
    std::size_t items() const { return wall_items() + edge_items() + obstacles_.items(); }
    void evaluate(const Motions& m, std::size_t first, std::size_t last);
    // Sums the records into forces, in fixed order; accumulates the work done on contact over the last step [J].
    void commit(const Motions& m, double last_dt);
    // Searches anew where nodes have moved far; `alive` tells which elements still exist.
    void search_when_needed(const Motions& m, const std::vector<std::uint8_t>& alive, bool force);
    ObstacleContact& obstacles() { return obstacles_; }
    const ObstacleContact& obstacles() const { return obstacles_; }

    const double* force() const { return now_.data(); }
    double work() const { return work_; }
    double deepest() const { return deepest_; }
    std::size_t searches() const { return searches_; }
    std::size_t touching() const { return now_.touched(); }

    // What a restart needs besides positions.
    std::vector<double> save() const;
    void restore(const std::vector<double>& saved);

private:
    std::size_t wall_items() const { return walls_ ? walls_->items() : 0; }
    std::size_t edge_items() const { return edges_ ? edges_->items() : 0; }
    bool moved_far(const Motions& m) const;

    Sheets sheets_;
    std::unique_ptr<WallContact> walls_;         // null without self-contact
    std::unique_ptr<EdgeContact> edges_;
    ObstacleContact obstacles_;
    NodeForces now_, before_;
    double skin_ = 0.0;                          // margin of the search [m]
    std::vector<double> searched_at_;            // positions of the last search
    double work_ = 0.0, deepest_ = 0.0;
    std::size_t searches_ = 0, checks_ = 0;
};

}  // namespace crumple::shell
