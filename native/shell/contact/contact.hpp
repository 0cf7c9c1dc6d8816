// Contact of walls with walls, edges with edges, and nodes with obstacles: penalty forces on nodes.
// Theory: docs/theory/contact.md.
#pragma once
#include <atomic>
#include <memory>

#include "shell/contact/edge_contact.hpp"
#include "shell/contact/obstacles.hpp"

namespace crumple::shell {

class Contact {
public:
    Contact(const Model& model, const Masses& masses, double step);

    bool any() const { return walls_ || obstacles_.any(); }

    // Where each node was when everything listed was last looked at, [node][position_record]; null if nobody asks.
    const double* seen() const { return walls_ ? seen_.data() : nullptr; }

    // A step, in this order; every member of the team calls what takes a member, one alone calls the rest.
    // Whether to look at everything again: `way2` is the square of the largest way that a node has made since [m2].
    void prepare(double way2);
    // Finds the touches at new positions; who is ready first takes more of them.
    void evaluate(const Motions& m, const Member& member);
    // Makes room for new forces and puts those of obstacles there.
    void turn_over(const Motions& m);
    // Sums the forces on the member's share of the nodes, in fixed order.
    void sum(const Motions& m, const Member& member);
    // Accumulates the work done on contact over the last step [J], and decides whether to search.
    void commit(double last_dt);
    // Nodes have moved so far that others may touch: `search` is to be called.
    bool search_due() const { return due_; }
    // Lists the candidates for contact again; `alive` is 1 for elements that still exist.
    void search(const Motions& m, const std::vector<std::uint8_t>& alive, const Member& member);

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
    std::size_t wall_items() const { return !walls_ ? 0 : all_ ? walls_->items() : walls_->close_items(); }
    std::size_t edge_items() const { return !edges_ ? 0 : all_ ? edges_->items() : edges_->close_items(); }
    std::size_t items() const { return wall_items() + edge_items() + obstacles_.items(); }
    bool moved_far(const Motions& m, Range nodes) const;

    Sheets sheets_;
    std::unique_ptr<WallContact> walls_;         // null without self-contact
    std::unique_ptr<EdgeContact> edges_;
    ObstacleContact obstacles_;
    std::vector<FoundForces> found_;             // [chunk of items]; those in use come first
    std::size_t chunks_ = 0;
    alignas(64) std::atomic<std::size_t> next_{0};       // chunk of items to be handed out
    NodeForces now_, before_;
    std::vector<double> power_;                  // of the forces at both ends of the step, [chunk of nodes] [W]
    double skin_ = 0.0;                          // margin of the search [m]
    std::vector<double> searched_at_;            // positions of the last search
    double margin_ = 0.0;                        // of what is close [m]
    aligned_vector<double> seen_;                // positions at the last look at all
    bool all_ = true;                            // this step looks at all
    double work_ = 0.0, deepest_ = 0.0;
    std::size_t searches_ = 0, checks_ = 0;
    std::atomic<bool> moved_{false};
    bool due_ = false;
};

}  // namespace crumple::shell
