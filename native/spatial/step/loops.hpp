// Which held rows others hold already: the rank of the loops' equations.
//
// A spanning tree of the joints carries every body.  A held row of a joint beyond the tree closes a loop; as a function of the free
// rates of the joints along it, it is a row of a matrix H (unit: rad/s and, over the model's length, m/s).  Rows of H that depend
// on others are redundant.  They are found by orthogonalisation of H itself, the largest remaining row first: with J M^-1 J^T,
// which has the squares, rounding of a well-conditioned loop passes what an independent row of another has left, and a row that is
// wrongly kept gets impulses without bounds.  Turning with the structure, another choice of rows becomes the best one, so the choice
// is made anew when a body has turned by `fresh`.
#pragma once

#include <vector>

#include "spatial/model/model.hpp"

namespace crumple::spatial {

class Loops {
public:
    explicit Loops(const Model& model);
    // Per joint and held row whether it is redundant, at the places where `geometry` has been located; true if this was found anew.
    bool find(const std::vector<JointGeometry>& geometry, const std::vector<Pose>& pose);
    bool redundant(size_t joint, int row) const { return redundant_[first_[joint] + static_cast<size_t>(row)] != 0; }

private:
    struct Branch {
        int parent = -1, joint = -1;  // towards the root; no joint: a root
        double sign = 1;              // +1 if the joint's second body is the outer one
        int depth = 0;
    };
    struct Part {
        Twist twist;  // of the outer body against the inner one, of the point below
        Vec3 point;
    };
    void free_parts(size_t joint, const JointGeometry& g);
    void equation(size_t joint, const JointGeometry& g, int row, double* out) const;
    void choose(size_t rows);

    const Model& model_;
    std::vector<Branch> branch_;                  // per body
    std::vector<size_t> closing_, first_, column_;  // joints beyond the tree; per joint its first row and column
    std::vector<Part> part_;                      // per column
    std::vector<char> redundant_;                 // per held row of all joints
    std::vector<Pose> found_at_;
    std::vector<double> matrix_;                  // rows of H
    std::vector<size_t> place_;                   // of its rows among all held ones
    size_t columns_ = 0;
};

}  // namespace crumple::spatial
