// Redundant held rows: the rank of the loops' constraint equations.
//
// A spanning tree of the joints connects all bodies.  A held row of a joint outside the tree closes a loop; as a function of the free
// rates of the joints along the loop, it is a row of a matrix H (unit: rad/s and, divided by the model's length, m/s).  Rows of H that
// depend on others are redundant.  They are found by orthogonalisation of H itself, largest remaining row first.  In J M^-1 J^T, which
// contains the squares, the rounding errors of a well-conditioned loop can exceed the remainder of an independent row of another loop,
// and a redundant row that is kept gets unbounded impulses.  As the structure rotates, another choice of rows becomes the best one, so
// the choice is repeated when a body has rotated by `fresh`.
#pragma once

#include <vector>

#include "spatial/model/model.hpp"

namespace crumple::spatial {

class Loops {
public:
    explicit Loops(const Model& model);
    // Finds which held rows are redundant at the positions where `geometry` has been located; true if the choice was made again.
    bool find(const std::vector<JointGeometry>& geometry, const std::vector<Pose>& pose);
    bool redundant(size_t joint, int row) const { return redundant_[first_[joint] + static_cast<size_t>(row)] != 0; }

private:
    struct Branch {
        int parent = -1, joint = -1;  // towards the root; no joint: a root
        double sign = 1;              // +1 if the joint's second body is the outer one
        int depth = 0;
    };
    struct Part {
        Twist twist;  // of the outer body relative to the inner one, at the point below
        Vec3 point;
    };
    void free_parts(size_t joint, const JointGeometry& g);
    void equation(size_t joint, const JointGeometry& g, int row, double* out) const;
    void choose(size_t rows);

    const Model& model_;
    std::vector<Branch> branch_;                  // per body
    std::vector<size_t> closing_, first_, column_;  // joints outside the tree; per joint its first row and column
    std::vector<Part> part_;                      // per column
    std::vector<char> redundant_;                 // per held row of all joints
    std::vector<Pose> found_at_;
    std::vector<double> matrix_;                  // rows of H
    std::vector<size_t> place_;                   // index of each of its rows among all held rows
    size_t columns_ = 0;
};

}  // namespace crumple::spatial
