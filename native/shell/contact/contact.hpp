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

    // Position of each node when all candidates were last checked, [node][position_record]; null without self-contact.
    const double* seen() const { return walls_ ? seen_.data() : nullptr; }

    // One step calls these functions in this order; those with a Member are called by every member of the team, the others by one.
    // Decides whether to check all candidates; `way2`: square of the largest displacement of a node since the last such check [m2].
    void prepare(double way2);
    // Finds the contacts at new positions; work is distributed dynamically among the members.
    void evaluate(const Motions& m, const Member& member);
    // Exchanges the buffers of new and old forces and enters the forces of obstacles.
    void turn_over(const Motions& m);
    // Sums the forces on the member's share of the nodes, in a fixed order.
    void sum(const Motions& m, const Member& member);
    // Accumulates the work done on contact over the last step [J], and decides whether to search.
    void commit(double last_dt);
    // Nodes have moved so far that pairs outside the list may come into contact: `search` must be called.
    bool search_due() const { return due_; }
    // Rebuilds the list of contact candidates; `alive` is 1 for elements that are not deleted.
    void search(const Motions& m, const std::vector<std::uint8_t>& alive, const Member& member);

    ObstacleContact& obstacles() { return obstacles_; }
    const ObstacleContact& obstacles() const { return obstacles_; }

    const double* force() const { return now_.data(); }
    double work() const { return work_; }
    double deepest() const { return deepest_; }
    std::size_t searches() const { return searches_; }
    std::size_t touching() const { return now_.touched(); }

    // State that a restart needs in addition to the positions.
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
    std::vector<FoundForces> found_;             // [chunk of items]; the first chunks_ are in use
    std::size_t chunks_ = 0;
    alignas(64) std::atomic<std::size_t> next_{0};       // next chunk of items to be evaluated
    NodeForces now_, before_;
    std::vector<double> power_;                  // of the forces at the start and the end of the step, [chunk of nodes] [W]
    double skin_ = 0.0;                          // margin of the search [m]
    std::vector<double> searched_at_;            // positions of the last search
    double margin_ = 0.0;                        // beyond the gap within which candidates are close [m]
    aligned_vector<double> seen_;                // positions when all candidates were last checked
    bool all_ = true;                            // this step checks all candidates
    double work_ = 0.0, deepest_ = 0.0;
    std::size_t searches_ = 0, checks_ = 0;
    std::atomic<bool> moved_{false};
    bool due_ = false;
};

}  // namespace crumple::shell
