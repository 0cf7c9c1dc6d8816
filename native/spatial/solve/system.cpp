#include "spatial/solve/system.hpp"

#include <algorithm>

namespace crumple::spatial {

namespace {

constexpr int refinements = 4;
// Relative tolerance to which the unknowns of laws are refined.
constexpr double law_tolerance = 1e-6, tiny = 1e-300;

size_t at(int i) { return static_cast<size_t>(i); }

template <int N>
struct Fixed {
    operator int() const { return N; }
};

// block (n x m) += sign p (n x 6) q (6 x most_rows, the first m)
template <class N, class M>
inline void add_products(double* block, const double* p, const double* q, double sign, N n, M m) {
    for (int i = 0; i < n; i++) {
        double row[most_rows] = {};
        for (int k = 0; k < 6; k++) {
            for (int j = 0; j < m; j++) row[j] += p[6 * i + k] * q[most_rows * k + j];
        }
        for (int j = 0; j < m; j++) block[i * m + j] += sign * row[j];
    }
}

}  // namespace

void System::analyse(size_t bodies, const std::vector<Link>& links) {
    links_ = links;
    bodies_.resize(bodies);
    impulse_.resize(bodies);
    impulse_sum_.resize(bodies);
    std::vector<int> size;
    std::vector<std::vector<int>> around(bodies);
    for (size_t c = 0; c < links.size(); c++) {
        size.push_back(links[c].rows());
        for (const int body : links[c].body) {
            if (body >= 0) around[at(body)].push_back(static_cast<int>(c));
        }
    }
    matrix_.analyse(size, around);
    pairs_.clear();
    for (size_t body = 0; body < bodies; body++) {
        for (const int a : around[body]) {
            for (const int b : around[body]) {
                if (a != b && !matrix_.later(a, b)) continue;
                const int side_a = links[at(a)].body[0] == static_cast<int>(body) ? 0 : 1;
                const int side_b = links[at(b)].body[0] == static_cast<int>(body) ? 0 : 1;
                pairs_.push_back({2 * b + side_b, 2 * a + side_a, size[at(b)], size[at(a)], matrix_.block(a, b), side_a != side_b});
            }
        }
    }
    const size_t n = at(matrix_.rows());
    rows_.resize(n);
    sides_.resize(2 * links.size());
    redundant_.assign(n, 0);
    for (auto* v : {&residual_, &correction_, &diagonal_, &rhs_, &floor_}) v->assign(n, 0.0);
    for (size_t c = 0; c < links.size(); c++) {
        for (int i = links[c].held; i < links[c].rows(); i++) floor_[at(start(c) + i)] = 1;
    }
}

void System::assemble() {
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
    matrix_.clear();
    double* values = matrix_.values();
    for (const Pair& pair : pairs_) {
        const double *p = sides_[at(pair.a)].p, *q = sides_[at(pair.b)].q;
        const double sign = pair.negative ? -1 : 1;
        if (pair.rows_a == 6 && pair.rows_b == 6) {
            add_products(values + pair.block, p, q, sign, Fixed<6>(), Fixed<6>());
        } else {
            add_products(values + pair.block, p, q, sign, pair.rows_a, pair.rows_b);
        }
    }
    for (size_t c = 0; c < links_.size(); c++) {
        const int n = links_[c].rows();
        double* block = values + matrix_.block(static_cast<int>(c), static_cast<int>(c));
        for (int i = 0; i < n; i++) {
            double& d = block[i * n + i];
            diagonal_[at(start(c) + i)] = d;
            if (i >= links_[c].held) d += 1;
        }
    }
}

void System::factor() {
    assemble();
    matrix_.factor(floor_, redundant_);
}

int System::redundant() const { return static_cast<int>(std::count(redundant_.begin(), redundant_.end(), 1)); }

int System::redundant(size_t link) const {
    const auto first = redundant_.begin() + start(link);
    return static_cast<int>(std::count(first, first + links_[link].rows(), 1));
}

void System::solve(double* x, double tolerance) {
    const size_t n = at(rows());
    std::copy(x, x + n, rhs_.begin());
    matrix_.solve(x);
    double last = INFINITY;
    for (int pass = 0; pass < refinements; pass++) {
        std::fill(impulse_.begin(), impulse_.end(), Twist{});
        push(x, impulse_.data());
        rates(impulse_.data(), residual_.data());
        double worst = 0;
        for (size_t c = 0; c < links_.size(); c++) {
            const int first = start(c), held = links_[c].held, count = links_[c].rows();
            double largest = 0;
            for (int i = held; i < count; i++) largest = std::max(largest, std::fabs(x[first + i]));
            // the change of the rates by the impulses is -J M^-1 J^T x
            for (int i = 0; i < count; i++) {
                const size_t k = at(first + i);
                residual_[k] += rhs_[k] - (i < held ? 0 : x[k]);
                const double left = std::fabs(residual_[k]);
                // the unknown of a locked hinge is small compared with the terms that cancel in it
                if (i < held) worst = std::max(worst, left / (tolerance + tiny));
                else if (left > law_tolerance * largest) worst = std::max(worst, left / (law_tolerance * largest + tiny));
            }
        }
        // stop if converged, or if rounding prevents further improvement
        if (!(worst > 1) || worst > last / 4) return;
        last = worst;
        correction_ = residual_;
        matrix_.solve(correction_.data());
        for (size_t k = 0; k < n; k++) x[k] += correction_[k];
    }
}

void System::rates(const Twist* v, double* out) const {
    for (size_t c = 0; c < links_.size(); c++) {
        const Link& link = links_[c];
        const Twist a = link.body[0] < 0 ? Twist{} : v[link.body[0]], b = link.body[1] < 0 ? Twist{} : v[link.body[1]];
        const int first = start(c);
        for (int i = 0; i < link.rows(); i++) out[first + i] = rate(rows_[at(first + i)], a, b);
    }
}

void System::push(const double* x, Twist* v) { push(rows_, x, false, v); }

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
