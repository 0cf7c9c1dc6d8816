// Products with small dense blocks, where the linear problem spends its time, compiled once for each instruction set.
//
// Every element is computed by the same operations in the same order whatever the width of the registers, so that all builds give the
// same bits.
#pragma once

namespace crumple::spatial {

// Largest number of rows of a block: six, of a joint.
constexpr int most_block = 6;

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
};

// the fastest build that this processor supports
const BlockKernels& block_kernels();

}  // namespace crumple::spatial
