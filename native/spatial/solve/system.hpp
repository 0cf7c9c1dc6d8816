// The linear problem of a Newton step for the impulses x along rows that link pairs of bodies.
//
//     (J M^-1 J^T + D^-1) x = rhs,      v -= M^-1 J^T x
//
// The rows of a law have its tangent D, which may be singular; held rows have D^-1 = 0.  Redundant held rows get no impulse and are
// satisfied because the constraints are consistent.  The matrix is well conditioned in terms of the unknowns y of the laws, x = R y with
// D = R R^T, from a free (D = 0) to a locked hinge (D very large).  Iterative refinement removes rounding errors.
//
// Redundancy depends only on the geometry of the loops, see loops.hpp.  Pivots do not show it: hinges that lock a loop give a held row
// a pivot of 1/D relative to the mobility, as small as that of a redundant row except for the digits that determine the moments in
// the loop.
#pragma once

#include <vector>

#include "spatial/solve/block_cholesky.hpp"
#include "spatial/model/joint.hpp"

namespace crumple::spatial {

struct Link {
    int body[2] = {-1, -1};
    int held = 0, laws = 0;
    int rows() const { return held + laws; }
};

class System {
public:
    void analyse(size_t bodies, const std::vector<Link>& links);
    const std::vector<Link>& links() const { return links_; }
    int start(size_t link) const { return matrix_.start(static_cast<int>(link)); }
    int rows() const { return matrix_.rows(); }
    void set_body(size_t i, double inverse_mass, const Mat3& inverse_inertia) {
        bodies_[i] = {inverse_mass, inverse_inertia};
    }
    // held row k gets no impulse
    void set_redundant(int k, bool is) { redundant_[static_cast<size_t>(k)] = is; }
    // assembles J M^-1 J^T
    void assemble(const std::vector<Row>& rows);
    // Tangent of a link's laws by its eigenvectors (n x n, one in each column) and the square roots of its eigenvalues (n).
    void set_tangent(size_t link, const double* vectors, const double* roots);
    // no impulses of laws
    void free_laws();
    // factorises the matrix with the present tangents
    void factor() {
        if (!left_.empty() && !matrix_.listed()) add_left();
        matrix_.factor(redundant_);
    }
    // number of redundant held rows
    int redundant() const;
    int redundant(size_t link) const;
    // x: right-hand side on input, impulses on output, refined until the held rows are satisfied within `tolerance`.  The effect of the
    // impulses is subtracted from the velocities v.
    void solve(double* x, double tolerance, Twist* v);
    // rates along the rows; and `push`: subtracts the effect of impulses along the rows from the velocities
    void rates(const Twist* v, double* out) const;
    void push(const double* x, Twist* v) { push(rows_, x, false, v); }
    // the same with other rows of the same links; only the impulses of laws if `laws_only`
    void push(const std::vector<Row>& rows, const double* x, bool laws_only, Twist* v);
    Twist mobility(size_t i, const Twist& impulse) const {
        return {bodies_[i].inverse_inertia * impulse.w, bodies_[i].inverse_mass * impulse.v};
    }
    // rate along a vector of a link's laws for a unit impulse along it, with both bodies free
    double mobility_along(size_t link, const double* vector) const;

private:
    struct Mobility {
        double inverse_mass = 1;
        Mat3 inverse_inertia;
    };
    // rows of a link at one of its bodies: p as they are, six numbers per row; q times the inverse mass, row index running fastest
    struct Side {
        double p[6 * most_rows], q[6 * most_rows];
    };
    struct Pair {
        int a, b;       // sides: 2 link + (0 or 1), b's link eliminated later
        int rows_a, rows_b;
        size_t block;
        bool negative;
        bool first;     // of those at this block
    };
    // Tangent of a law, D = V diag(root^2) V^T.
    struct Tangent {
        double vectors[most_laws * most_laws] = {}, root[most_laws] = {};
    };
    bool idle(const Pair& pair) const { return matrix_.idle(pair.a / 2) || matrix_.idle(pair.b / 2); }
    void add(const Pair& pair);
    void add_left();
    double imbalance(const double* x, double tolerance);
    double largest_of_laws(size_t link, const double* x) const;

    const BlockKernels& blocks_ = block_kernels();
    std::vector<Link> links_;
    std::vector<Mobility> bodies_;
    std::vector<Row> rows_;
    std::vector<Side> sides_;
    std::vector<Pair> pairs_;
    std::vector<size_t> left_;     // pairs that are not in the matrix because one of their nodes was idle
    BlockCholesky matrix_;
    std::vector<char> redundant_;  // per row
    std::vector<Tangent> tangent_;  // per link
    std::vector<double> residual_, correction_, rhs_;
    std::vector<Twist> impulse_, impulse_sum_;
};

}  // namespace crumple::spatial
