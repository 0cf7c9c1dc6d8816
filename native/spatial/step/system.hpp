// The linear problem of a Newton step, in impulses along rows that link bodies two by two.
//
//     (J M^-1 J^T + diag) x = rhs,      v -= M^-1 J^T x
//
// Held rows have nothing on the diagonal; those that others make redundant get no impulse, and are met because they are
// consistent.  Rows of a law come with the root of its tangent, J^ = L^T J with D = L L^T, and 1 on the diagonal:
// well conditioned from a free (D = 0) to a locked hinge (D huge).  Refinement takes rounding out.
//
// Redundant is a matter of the loops' geometry alone, see loops.hpp.  Pivots do not show it: hinges that lock a loop leave a held row a
// pivot of 1/D beside the mobility, as small as a redundant one's except for the digits that determine the moments in the loop.
#pragma once

#include <vector>

#include "spatial/step/block_cholesky.hpp"
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
    Row& row(int k) { return rows_[static_cast<size_t>(k)]; }
    void set_body(size_t i, double inverse_mass, const Mat3& inverse_inertia) {
        bodies_[i] = {inverse_mass, inverse_inertia};
    }
    // held row k gets no impulse
    void set_redundant(int k, bool is) { redundant_[static_cast<size_t>(k)] = is; }
    // assembles and factors
    void factor();
    // number of redundant held rows
    int redundant() const;
    int redundant(size_t link) const;
    // x: right-hand side in, impulses out, refined until the held rows are met within `tolerance`
    void solve(double* x, double tolerance);
    // rates along the rows, and what impulses along the rows take from the velocities
    void rates(const Twist* v, double* out) const;
    void push(const double* x, Twist* v);
    // the same for other rows of the same links: `row` per row, from impulses of laws only if `laws_only`
    void push(const std::vector<Row>& rows, const double* x, bool laws_only, Twist* v);
    Twist mobility(size_t i, const Twist& impulse) const {
        return {bodies_[i].inverse_inertia * impulse.w, bodies_[i].inverse_mass * impulse.v};
    }
    // diagonal of J M^-1 J^T, as of the last assembly
    double diagonal(int k) const { return diagonal_[static_cast<size_t>(k)]; }

private:
    struct Mobility {
        double inverse_mass = 1;
        Mat3 inverse_inertia;
    };
    // a link's rows at one of its bodies: as they are, six numbers a row, and times the inverse mass, number by number
    struct Side {
        double p[6 * most_rows], q[6 * most_rows];
    };
    struct Pair {
        int a, b;       // sides: 2 link + (0 or 1), b's link eliminated later
        int rows_a, rows_b;
        size_t block;
        bool negative;
    };
    void assemble();

    std::vector<Link> links_;
    std::vector<Mobility> bodies_;
    std::vector<Row> rows_;
    std::vector<Side> sides_;
    std::vector<Pair> pairs_;
    BlockCholesky matrix_;
    std::vector<char> redundant_;  // per row
    std::vector<double> residual_, correction_, diagonal_, rhs_, floor_;
    std::vector<Twist> impulse_, impulse_sum_;
};

}  // namespace crumple::spatial
