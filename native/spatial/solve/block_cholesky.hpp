// Cholesky factorisation of a sparse symmetric matrix of small dense blocks, with one node per connection of bodies.
//
// The pattern is analysed once: nodes are eliminated in minimum degree order, and the target of every product of two blocks
// is stored, so that factorisation is a pass over flat lists without allocation.  A chain costs O(N).
#pragma once

#include <cstddef>
#include <vector>

namespace crumple::spatial {

using std::size_t;

class BlockCholesky {
public:
    // `size`: number of rows of every node; `cliques`: sets of nodes that are all coupled with each other (those at one body)
    void analyse(const std::vector<int>& size, const std::vector<std::vector<int>>& cliques);
    // start of the block of two coupled nodes; the row index of the node eliminated later runs fastest
    size_t block(int a, int b) const;
    bool later(int a, int b) const { return place_[static_cast<size_t>(a)] > place_[static_cast<size_t>(b)]; }
    double* values() { return values_.data(); }
    // first row of a node in a right-hand side, and the number of all rows
    int start(int node) const { return start_[static_cast<size_t>(node)]; }
    int rows() const { return start_.back(); }
    void clear();
    // Redundant rows get a zero solution.  The pivot of a row with a floor is at least that floor, of others at least rounding.
    void factor(const std::vector<double>& floor, const std::vector<char>& redundant);
    void solve(double* x) const;

private:
    struct Entry {
        int node;
        size_t block;
    };
    struct Update {
        size_t target, a, b;  // target -= b^T a
        int rows_a, rows_b;
    };
    void eliminate(const std::vector<int>& size, std::vector<std::vector<int>>& near);
    void factor_diagonal(int node, const double* floor, const char* redundant);

    std::vector<int> size_, start_, order_, place_;
    std::vector<size_t> diagonal_, first_, first_update_;  // per node; per position in the order of elimination
    std::vector<Entry> below_;
    std::vector<Update> update_;
    std::vector<double> values_, inverse_;  // blocks; reciprocals of the pivots
};

}  // namespace crumple::spatial
