// Cholesky factorisation of a sparse symmetric matrix of small dense blocks, with one node per connection of bodies.
//
// A node has held rows, then rows of laws.  For those the matrix is A + D^-1 with the tangent D = R R^T of the law, which may vanish along
// some directions and be very large along others.  Of the part S of A that is left when the rows before are eliminated, the law part is
// inverted as (S + D^-1)^-1 = W^T W with W = G^-1 R^T and G G^T = 1 + R^T S R: well conditioned for any D.
//
// The pattern is analysed once: nodes are eliminated in minimum degree order.  Nodes without held rows and tangent, as those of contacts
// that are open, have no impulse and are left out: the blocks that the other nodes need are listed, with the target of every product of two of
// them, when the set of such nodes changes, so that factorisation is a pass over flat lists without allocation.  A chain costs O(N).  If
// only some tangents have changed, only their columns are factorised again and those that depend on them.
#pragma once

#include <cstddef>
#include <vector>

#include "spatial/solve/block_kernels.hpp"

namespace crumple::spatial {

using std::size_t;

class BlockCholesky {
public:
    // `held`, `laws`: number of rows of every node; `cliques`: sets of nodes that are all coupled with each other (those at one body)
    void analyse(const std::vector<int>& held, const std::vector<int>& laws, const std::vector<std::vector<int>>& cliques);
    // start of the block of two coupled nodes in A; the row index of the node eliminated later runs fastest
    size_t block(int a, int b) const;
    bool later(int a, int b) const { return place_[static_cast<size_t>(a)] > place_[static_cast<size_t>(b)]; }
    // A, without the inverse tangents
    double* values() { return values_.data(); }
    const double* values() const { return values_.data(); }
    // first row of a node in a right-hand side, and the number of all rows
    int start(int node) const { return start_[static_cast<size_t>(node)]; }
    int rows() const { return start_.back(); }
    // Before all of A is set again; blocks that only the factor has stay zero, and those of idle nodes are not used.
    void renew();
    // number of values
    std::size_t size() const { return values_.size(); }
    // whether a node has neither held rows nor a tangent; and whether the same nodes were idle when A was last factorised
    bool idle(int node) const { return idle_[static_cast<std::size_t>(node)] != 0; }
    bool listed() const { return listed_; }
    // sets the root R of a node's tangent (laws x laws, row by row)
    void set_root(int node, const double* root);
    // Factorises A with the present tangents.  Redundant rows get a zero solution; the pivots of other held rows are at least rounding.
    void factor(const std::vector<char>& redundant);
    void solve(double* x) const;

private:
    struct Entry {
        int node;
        size_t block;
        bool filled;  // zero in A
    };
    struct Update {
        size_t target, a, b;  // target -= b^T a
        int rows_a, inner;
    };
    void eliminate(std::vector<std::vector<int>>& near);
    void list_used();
    void list_updates();
    template <class Use>
    void each_product(size_t k, Use use) const;
    void factor_column(size_t k, const std::vector<char>& redundant);
    BlockRows rows_of(int node) const { return {held_[static_cast<size_t>(node)], size_[static_cast<size_t>(node)]}; }

    const BlockKernels& blocks_ = block_kernels();
    std::vector<int> held_, laws_, size_, start_, order_, place_;
    std::vector<size_t> diagonal_, first_, first_used_, first_update_;  // per node; per position in the order of elimination
    std::vector<Entry> below_, used_;       // all blocks, and those that are not zero for lack of tangents
    std::vector<Update> update_;            // of used blocks, by the column of the target
    bool listed_ = false;                   // whether the lists are those of the present idle nodes
    std::vector<char> idle_;                // per node: neither held rows nor a tangent
    std::vector<double> values_, factor_;   // blocks of A, and of its factor
    std::vector<double> inverse_;           // reciprocals of the pivots of held rows
    std::vector<double> root_;              // per node
    std::vector<char> changed_;             // per node: whether its column must be factorised again
};

}  // namespace crumple::spatial
