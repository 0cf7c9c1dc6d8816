#include "spatial/solve/system.hpp"

#include <algorithm>
#include <utility>

#include "common/machine.hpp"

namespace crumple::spatial {

namespace {

constexpr int refinements = 4;
// Relative tolerance to which the unknowns of laws are refined.
constexpr double law_tolerance = 1e-6, tiny = 1e-300;

size_t at(int i) { return static_cast<size_t>(i); }

}  // namespace

extern const BlockKernels blocks_plain;
#if defined(__x86_64__)
extern const BlockKernels blocks_v3;
#endif

const BlockKernels& block_kernels() {
#if defined(__x86_64__)
    static const bool wide = x86_level() >= 3;
    if (wide) return blocks_v3;
#endif
    return blocks_plain;
}

void System::analyse(size_t bodies, const std::vector<Link>& links) {
    links_ = links;
    bodies_.resize(bodies);
    impulse_.resize(bodies);
    impulse_sum_.resize(bodies);
    std::vector<int> held, laws;
    std::vector<std::vector<int>> around(bodies);
    for (size_t c = 0; c < links.size(); c++) {
        held.push_back(links[c].held);
        laws.push_back(links[c].laws);
        for (const int body : links[c].body) {
            if (body >= 0) around[at(body)].push_back(static_cast<int>(c));
        }
    }
    matrix_.analyse(held, laws, around);
    pairs_.clear();
    for (size_t body = 0; body < bodies; body++) {
        for (const int a : around[body]) {
            for (const int b : around[body]) {
                if (a != b && !matrix_.later(a, b)) continue;
                const int side_a = links[at(a)].body[0] == static_cast<int>(body) ? 0 : 1;
                const int side_b = links[at(b)].body[0] == static_cast<int>(body) ? 0 : 1;
                pairs_.push_back({2 * b + side_b, 2 * a + side_a, links[at(b)].rows(), links[at(a)].rows(), matrix_.block(a, b), side_a != side_b, false});
            }
        }
    }
    std::vector<char> seen(matrix_.size(), 0);
    for (Pair& pair : pairs_) pair.first = !std::exchange(seen[pair.block], char(1));
    left_.clear();
    const size_t n = at(matrix_.rows());
    rows_.resize(n);
    sides_.resize(2 * links.size());
    redundant_.assign(n, 0);
    for (auto* v : {&residual_, &correction_, &rhs_}) v->assign(n, 0.0);
    tangent_.assign(links.size(), Tangent());
}

void System::assemble(const std::vector<Row>& rows) {
    rows_ = rows;
    for (size_t c = 0; c < links_.size(); c++) {
        const Link& link = links_[c];
        const Row* row = &rows_[at(start(c))];
        for (int side = 0; side < 2; side++) {
            if (link.body[side] < 0) continue;
            const Mobility& body = bodies_[at(link.body[side])];
            Side& s = sides_[2 * c + at(side)];
            for (int i = 0; i < link.rows(); i++) {
                const Vec3 t = row[i].t, m = side == 0 ? row[i].ma : row[i].mb;
                const Vec3 u = body.inverse_mass * t, w = body.inverse_inertia * m;
                const double own[6] = {t.x, t.y, t.z, m.x, m.y, m.z}, pushed[6] = {u.x, u.y, u.z, w.x, w.y, w.z};
                for (int k = 0; k < 6; k++) {
                    s.p[6 * i + k] = own[k];
                    s.q[most_rows * k + i] = pushed[k];
                }
            }
        }
    }
    matrix_.renew();
    left_.clear();
    for (size_t i = 0; i < pairs_.size(); i++) {
        // most contacts within reach are open
        if (pairs_[i].a / 2 != pairs_[i].b / 2 && idle(pairs_[i])) {
            left_.push_back(i);
        } else {
            add(pairs_[i]);
        }
    }
}

void System::add(const Pair& pair) {
    const double *p = sides_[at(pair.a)].p, *q = sides_[at(pair.b)].q;
    double* block = matrix_.values() + pair.block;
    if (pair.first) std::fill_n(block, pair.rows_a * pair.rows_b, 0.0);
    blocks_.add_product(block, p, q, pair.negative ? -1 : 1, pair.rows_a, pair.rows_b);
}

// adds the pairs whose nodes have got tangents since the matrix was assembled
void System::add_left() {
    size_t kept = 0;
    for (const size_t i : left_) {
        if (idle(pairs_[i])) {
            left_[kept++] = i;
        } else {
            add(pairs_[i]);
        }
    }
    left_.resize(kept);
}

void System::set_tangent(size_t link, const double* vectors, const double* roots) {
    const int n = links_[link].laws;
    Tangent& t = tangent_[link];
    std::copy(vectors, vectors + n * n, t.vectors);
    std::copy(roots, roots + n, t.root);
    double root[most_laws * most_laws];
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) root[i * n + k] = vectors[i * n + k] * roots[k];
    }
    matrix_.set_root(static_cast<int>(link), root);
}

void System::free_laws() {
    const Tangent none;
    for (size_t c = 0; c < links_.size(); c++) set_tangent(c, none.vectors, none.root);
}

double System::mobility_along(size_t link, const double* vector) const {
    const int n = links_[link].rows(), held = links_[link].held, c = static_cast<int>(link);
    const double* block = matrix_.values() + matrix_.block(c, c) + held * (n + 1);
    double sum = 0;
    for (int i = 0; i < n - held; i++) {
        for (int j = 0; j < n - held; j++) sum += vector[i] * block[i * n + j] * vector[j];
    }
    return sum;
}

int System::redundant() const { return static_cast<int>(std::count(redundant_.begin(), redundant_.end(), 1)); }

int System::redundant(size_t link) const {
    const auto first = redundant_.begin() + start(link);
    return static_cast<int>(std::count(first, first + links_[link].rows(), 1));
}

void System::solve(double* x, double tolerance, Twist* v) {
    const size_t n = at(rows());
    std::copy(x, x + n, rhs_.begin());
    matrix_.solve(x);
    double last = INFINITY;
    for (int pass = 0;; pass++) {
        std::fill(impulse_.begin(), impulse_.end(), Twist{});
        push(x, impulse_.data());
        if (pass == refinements) break;
        rates(impulse_.data(), residual_.data());
        const double worst = imbalance(x, tolerance);
        // stop if converged, or if rounding prevents further improvement
        if (!(worst > 1) || worst > last / 4) break;
        last = worst;
        correction_ = residual_;
        matrix_.solve(correction_.data());
        for (size_t k = 0; k < n; k++) x[k] += correction_[k];
    }
    for (size_t i = 0; i < bodies_.size(); i++) v[i] = v[i] + impulse_[i];
}

// Completes the residuals of the rows, whose change of the rates by the impulses, -J M^-1 J^T x, they hold; largest one over its tolerance.
double System::imbalance(const double* x, double tolerance) {
    // the unknowns of joints are refined relative to the largest one: small ones, of lightly loaded hinges, decide nothing
    double largest_of_joints = 0;
    for (size_t c = 0; c < links_.size(); c++) {
        if (links_[c].held > 0) largest_of_joints = std::max(largest_of_joints, largest_of_laws(c, x));
    }
    double worst = 0;
    for (size_t c = 0; c < links_.size(); c++) {
        const int held = links_[c].held, n = links_[c].laws;
        double* r = &residual_[at(start(c))];
        for (int i = 0; i < held + n; i++) r[i] += rhs_[at(start(c) + i)];
        for (int i = 0; i < held; i++) worst = std::max(worst, std::fabs(r[i]) / (tolerance + tiny));
        if (n == 0) continue;
        const double law = law_tolerance * (held > 0 ? largest_of_joints : largest_of_laws(c, x)) + tiny;
        const Tangent& t = tangent_[c];
        double left[most_laws] = {};
        for (int k = 0; k < n; k++) {
            // without stiffness there is no impulse, and the rate is free
            if (t.root[k] == 0) continue;
            double along = 0;
            for (int j = 0; j < n; j++) along += t.vectors[j * n + k] * (r[held + j] - x[start(c) + held + j] / (t.root[k] * t.root[k]));
            worst = std::max(worst, t.root[k] * std::fabs(along) / law);
            for (int j = 0; j < n; j++) left[j] += t.vectors[j * n + k] * along;
        }
        std::copy(left, left + n, r + held);
    }
    return worst;
}

// Largest unknown y of a link's laws.
double System::largest_of_laws(size_t link, const double* x) const {
    const int n = links_[link].laws;
    const double* own = x + start(link) + links_[link].held;
    const Tangent& t = tangent_[link];
    double largest = 0;
    for (int k = 0; k < n; k++) {
        double along = 0;
        for (int j = 0; j < n && t.root[k] > 0; j++) along += t.vectors[j * n + k] * own[j] / t.root[k];
        largest = std::max(largest, std::fabs(along));
    }
    return largest;
}

void System::rates(const Twist* v, double* out) const {
    for (size_t c = 0; c < links_.size(); c++) {
        const Link& link = links_[c];
        const Twist a = link.body[0] < 0 ? Twist{} : v[link.body[0]], b = link.body[1] < 0 ? Twist{} : v[link.body[1]];
        const int first = start(c);
        for (int i = 0; i < link.rows(); i++) out[first + i] = rate(rows_[at(first + i)], a, b);
    }
}

void System::push(const std::vector<Row>& rows, const double* x, bool laws_only, Twist* v) {
    std::vector<Twist>& sum = impulse_sum_;
    std::fill(sum.begin(), sum.end(), Twist{});
    for (size_t c = 0; c < links_.size(); c++) {
        const Link& link = links_[c];
        const int first = start(c);
        Twist a, b;
        for (int i = laws_only ? link.held : 0; i < link.rows(); i++) {
            const Row& row = rows[at(first + i)];
            const double s = x[first + i];
            a = a + s * Twist{row.ma, row.t};
            b = b + s * Twist{row.mb, row.t};
        }
        if (link.body[0] >= 0) sum[at(link.body[0])] = sum[at(link.body[0])] + a;
        if (link.body[1] >= 0) sum[at(link.body[1])] = sum[at(link.body[1])] - b;
    }
    for (size_t i = 0; i < bodies_.size(); i++) v[i] = v[i] + mobility(i, sum[i]);
}

}  // namespace crumple::spatial
