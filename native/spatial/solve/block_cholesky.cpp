#include "spatial/solve/block_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "common/pause.hpp"

namespace crumple::spatial {

namespace {

size_t at(int i) { return static_cast<size_t>(i); }

// Largest number of rows of a node: six, of a joint.
constexpr int most_block = 6;
// Share of the diagonal below which a pivot is rounding; smaller pivots are raised to it, and refinement corrects the solution.
constexpr double rounding = 2.2e-16;

// Compile-time sizes of the most common blocks: six rows of joints, three of contacts.
template <int N>
struct Fixed {
    operator int() const { return N; }
};

template <class Use>
inline void with_size(int n, Use use) {
    if (n == 6) {
        use(Fixed<6>());
    } else if (n == 3) {
        use(Fixed<3>());
    } else {
        use(n);
    }
}

// The index of the node eliminated later runs fastest in a block, so that the innermost loops have no reductions and vectorise.
// target (m x n) -= b (k x m)^T a (k x n)
template <class N, class M, class K>
inline void subtract_product(double* target, const double* a, const double* b, N n, M m, K k) {
    for (int j = 0; j < m; j++) {
        double row[most_block];
        for (int i = 0; i < n; i++) row[i] = target[j * n + i];
        for (int l = 0; l < k; l++) {
            for (int i = 0; i < n; i++) row[i] -= b[l * m + j] * a[l * n + i];
        }
        for (int i = 0; i < n; i++) target[j * n + i] = row[i];
    }
}

// b (k x n) := L^-1 b, L lower triangular (k x k) with reciprocal diagonal
template <class N, class K>
inline void solve_rows(double* b, const double* lower, const double* reciprocal, N n, K k) {
    for (int j = 0; j < k; j++) {
        double* row = b + j * n;
        for (int l = 0; l < j; l++) {
            for (int i = 0; i < n; i++) row[i] -= lower[j * k + l] * b[l * n + i];
        }
        for (int i = 0; i < n; i++) row[i] *= reciprocal[j];
    }
}

// other (n) -= b (k x n)^T own (k)
template <class N, class K>
inline void carry_forward(double* other, const double* b, const double* own, N n, K k) {
    for (int l = 0; l < k; l++) {
        for (int i = 0; i < n; i++) other[i] -= b[l * n + i] * own[l];
    }
}

// own (k) -= b (k x n) other (n)
template <class N, class K>
inline void carry_back(double* own, const double* b, const double* other, N n, K k) {
    for (int l = 0; l < k; l++) {
        double s = 0;
        for (int i = 0; i < n; i++) s += b[l * n + i] * other[i];
        own[l] -= s;
    }
}

}  // namespace

void BlockCholesky::analyse(const std::vector<int>& size, const std::vector<std::vector<int>>& cliques) {
    const int n = static_cast<int>(size.size());
    size_ = size;
    start_.assign(at(n) + 1, 0);
    for (int i = 0; i < n; i++) start_[at(i) + 1] = start_[at(i)] + size[at(i)];
    std::vector<std::vector<int>> near(at(n));
    for (const auto& clique : cliques) {
        for (const int a : clique) {
            for (const int b : clique) {
                if (a != b) near[at(a)].push_back(b);
            }
        }
    }
    for (auto& list : near) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    eliminate(size, near);
    values_.assign(values_.size(), 0.0);
    inverse_.assign(at(start_.back()), 0.0);
}

// Minimum degree with the graph of the factor kept explicitly: `near` holds the neighbours that are not yet eliminated.
void BlockCholesky::eliminate(const std::vector<int>& size, std::vector<std::vector<int>>& near) {
    const int n = static_cast<int>(size.size());
    order_.clear();
    place_.assign(at(n), -1);
    diagonal_.assign(at(n), 0);
    std::set<std::pair<size_t, int>> queue;
    for (int i = 0; i < n; i++) queue.insert({near[at(i)].size(), i});
    std::vector<std::vector<int>> columns;
    std::vector<int> merged;
    while (!queue.empty()) {
        pause();
        const int node = queue.begin()->second;
        queue.erase(queue.begin());
        place_[at(node)] = static_cast<int>(order_.size());
        order_.push_back(node);
        const std::vector<int> column = std::move(near[at(node)]);
        for (const int a : column) {
            auto& list = near[at(a)];
            queue.erase({list.size(), a});
            merged.clear();
            std::set_union(list.begin(), list.end(), column.begin(), column.end(), std::back_inserter(merged));
            merged.erase(std::remove_if(merged.begin(), merged.end(), [&](int b) { return b == a || b == node; }), merged.end());
            list = merged;
            queue.insert({list.size(), a});
        }
        columns.push_back(column);
    }
    // positions of the blocks, column by column
    size_t next = 0;
    first_.assign(1, 0);
    below_.clear();
    for (int k = 0; k < n; k++) {
        const int node = order_[at(k)];
        diagonal_[at(node)] = next;
        next += at(size[at(node)] * size[at(node)]);
        auto& column = columns[at(k)];
        std::sort(column.begin(), column.end(), [&](int a, int b) { return place_[at(a)] < place_[at(b)]; });
        for (const int a : column) {
            below_.push_back({a, next});
            next += at(size[at(a)] * size[at(node)]);
        }
        first_.push_back(below_.size());
    }
    values_.resize(next);
    update_.clear();
    first_update_.assign(1, 0);
    for (int k = 0; k < n; k++) {
        for (size_t p = first_[at(k)]; p < first_[at(k) + 1]; p++) {
            for (size_t q = first_[at(k)]; q <= p; q++) {
                const int a = below_[p].node, b = below_[q].node;
                update_.push_back({block(a, b), below_[p].block, below_[q].block, size[at(a)], size[at(b)]});
            }
        }
        first_update_.push_back(update_.size());
    }
}

size_t BlockCholesky::block(int a, int b) const {
    if (a == b) return diagonal_[at(a)];
    if (!later(a, b)) std::swap(a, b);
    const size_t k = at(place_[at(b)]);
    const auto begin = below_.begin() + static_cast<std::ptrdiff_t>(first_[k]), end = below_.begin() + static_cast<std::ptrdiff_t>(first_[k + 1]);
    const int wanted = place_[at(a)];
    return std::lower_bound(begin, end, wanted, [&](const Entry& e, int place) { return place_[at(e.node)] < place; })->block;
}

void BlockCholesky::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

// Cholesky factor of a diagonal block, in its lower triangle, and the reciprocals of the pivots.
void BlockCholesky::factor_diagonal(int node, const double* floor, const char* redundant) {
    const int n = size_[at(node)];
    double* a = &values_[diagonal_[at(node)]];
    double* reciprocal = &inverse_[at(start_[at(node)])];
    for (int j = 0; j < n; j++) {
        double pivot = a[j * n + j];
        for (int k = 0; k < j; k++) pivot -= a[j * n + k] * a[j * n + k];
        // up to here `reciprocal` holds the diagonal before elimination
        if (redundant[j]) {
            a[j * n + j] = 0;
            reciprocal[j] = 0;
            for (int i = j + 1; i < n; i++) a[i * n + j] = 0;
            continue;
        }
        pivot = std::max(pivot, floor[j] > 0 ? floor[j] : rounding * reciprocal[j]);
        a[j * n + j] = std::sqrt(pivot);
        reciprocal[j] = 1 / a[j * n + j];
        for (int i = j + 1; i < n; i++) {
            double s = a[i * n + j];
            for (int k = 0; k < j; k++) s -= a[i * n + k] * a[j * n + k];
            a[i * n + j] = s * reciprocal[j];
        }
    }
}

void BlockCholesky::factor(const std::vector<double>& floor, const std::vector<char>& redundant) {
    for (size_t node = 0; node < size_.size(); node++) {
        const int n = size_[node];
        for (int i = 0; i < n; i++) inverse_[at(start_[node] + i)] = values_[diagonal_[node] + at(i * n + i)];
    }
    for (size_t k = 0; k < order_.size(); k++) {
        pause();
        const int node = order_[k], n = size_[at(node)];
        const size_t first = at(start_[at(node)]);
        factor_diagonal(node, &floor[first], &redundant[first]);
        const double *lower = &values_[diagonal_[at(node)]], *reciprocal = &inverse_[at(start_[at(node)])];
        for (size_t p = first_[k]; p < first_[k + 1]; p++) {
            double* b = &values_[below_[p].block];
            const int rows = size_[at(below_[p].node)];
            with_size(rows, [&](auto m) { with_size(n, [&](auto k) { solve_rows(b, lower, reciprocal, m, k); }); });
        }
        for (size_t p = first_update_[k]; p < first_update_[k + 1]; p++) {
            const Update& u = update_[p];
            double *target = &values_[u.target], *a = &values_[u.a], *b = &values_[u.b];
            with_size(u.rows_a, [&](auto l) {
                with_size(u.rows_b, [&](auto m) { with_size(n, [&](auto k) { subtract_product(target, a, b, l, m, k); }); });
            });
        }
    }
}

void BlockCholesky::solve(double* x) const {
    for (size_t k = 0; k < order_.size(); k++) {
        const int node = order_[k], n = size_[at(node)];
        double* own = x + start_[at(node)];
        const double *lower = &values_[diagonal_[at(node)]], *reciprocal = &inverse_[at(start_[at(node)])];
        for (int j = 0; j < n; j++) {
            double s = own[j];
            for (int l = 0; l < j; l++) s -= lower[j * n + l] * own[l];
            own[j] = s * reciprocal[j];
        }
        for (size_t p = first_[k]; p < first_[k + 1]; p++) {
            const int rows = size_[at(below_[p].node)];
            double* other = x + start_[at(below_[p].node)];
            const double* b = &values_[below_[p].block];
            with_size(rows, [&](auto m) { with_size(n, [&](auto k) { carry_forward(other, b, own, m, k); }); });
        }
    }
    for (size_t k = order_.size(); k-- > 0;) {
        const int node = order_[k], n = size_[at(node)];
        double* own = x + start_[at(node)];
        const double *lower = &values_[diagonal_[at(node)]], *reciprocal = &inverse_[at(start_[at(node)])];
        for (size_t p = first_[k]; p < first_[k + 1]; p++) {
            const int rows = size_[at(below_[p].node)];
            const double *other = x + start_[at(below_[p].node)], *b = &values_[below_[p].block];
            with_size(rows, [&](auto m) { with_size(n, [&](auto k) { carry_back(own, b, other, m, k); }); });
        }
        for (int j = n - 1; j >= 0; j--) {
            double s = own[j];
            for (int l = j + 1; l < n; l++) s -= lower[l * n + j] * own[l];
            own[j] = s * reciprocal[j];
        }
    }
}

}  // namespace crumple::spatial
