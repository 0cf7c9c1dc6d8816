// Products with small dense blocks and their factors, where the linear problem spends its time, compiled once for each instruction set.
//
// Every element is computed by the same operations in the same order whatever the width of the registers, so that all builds give the
// same bits.
#pragma once

namespace crumple::spatial {

// Largest number of rows of a block: six, of a joint.
constexpr int most_block = 6;
// Largest number of laws of a link.
constexpr int most_laws = 4;

// Number of held rows of a diagonal block, which come first, and of all its rows.
struct BlockRows {
    int held, all;
};

// Blocks are stored row by row; the row index of the node eliminated later runs fastest in a block.
struct BlockKernels {
    // target (m x n) -= b (k x m)^T a (k x n)
    void (*subtract_product)(double* target, const double* a, const double* b, int n, int m, int k);
    // block (n x m) += sign p (n x 6) q (6 x most_block, the first m)
    void (*add_product)(double* block, const double* p, const double* q, double sign, int n, int m);
    // b (k x n) := L^-1 b with the factor of a diagonal block (k x k): reciprocal pivots for its first rows, which are held, W for the others
    void (*solve_rows)(double* b, const double* lower, const double* reciprocal, int held, int n, int k);
    // other (n) -= b (k x n)^T own (k)
    void (*carry_forward)(double* other, const double* b, const double* own, int n, int k);
    // own (k) -= b (k x n) other (n)
    void (*carry_back)(double* own, const double* b, const double* other, int n, int k);
    // Factor of a diagonal block a (n x n), of which the first rows are held, in its lower triangle: W = G^-1 R^T with the root R (n - held
    // squared) in the place of the laws.  `before`: the block before elimination; redundant held rows get the reciprocal pivot 0.
    void (*factor_diagonal)(double* a, double* reciprocal, const double* before, const double* root, const char* redundant, BlockRows rows);
    // own (n) := L^-1 own, and L^-T own, with such a factor
    void (*forward)(double* own, const double* lower, const double* reciprocal, BlockRows rows);
    void (*backward)(double* own, const double* lower, const double* reciprocal, BlockRows rows);
};

// the fastest build that this processor supports
const BlockKernels& block_kernels();

}  // namespace crumple::spatial
