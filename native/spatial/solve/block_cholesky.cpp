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

}  // namespace

void BlockCholesky::analyse(const std::vector<int>& held, const std::vector<int>& laws, const std::vector<std::vector<int>>& cliques) {
    const int n = static_cast<int>(held.size());
    held_ = held;
    laws_ = laws;
    size_ = held;
    start_.assign(at(n) + 1, 0);
    for (int i = 0; i < n; i++) size_[at(i)] += laws[at(i)];
    for (int i = 0; i < n; i++) start_[at(i) + 1] = start_[at(i)] + size_[at(i)];
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
    eliminate(near);
    values_.assign(values_.size(), 0.0);
    factor_ = values_;
    inverse_.assign(at(start_.back()), 0.0);
    root_.assign(at(n) * most_laws * most_laws, 0.0);
    changed_.assign(at(n), 1);
    idle_.assign(at(n), 0);
    for (int i = 0; i < n; i++) idle_[at(i)] = held[at(i)] == 0;
    listed_ = false;
}

// Minimum degree with the graph of the factor kept explicitly: `near` holds the neighbours that are not yet eliminated.
void BlockCholesky::eliminate(std::vector<std::vector<int>>& near) {
    const int n = static_cast<int>(size_.size());
    order_.clear();
    place_.assign(at(n), -1);
    diagonal_.assign(at(n), 0);
    const std::vector<std::vector<int>> coupled = near;
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
        next += at(size_[at(node)] * size_[at(node)]);
        auto& column = columns[at(k)];
        std::sort(column.begin(), column.end(), [&](int a, int b) { return place_[at(a)] < place_[at(b)]; });
        for (const int a : column) {
            below_.push_back({a, next, !std::binary_search(coupled[at(node)].begin(), coupled[at(node)].end(), a)});
            next += at(size_[at(a)] * size_[at(node)]);
        }
        first_.push_back(below_.size());
    }
    values_.resize(next);
}

// Calls `use` with the products of two used blocks of a column: their indices p >= q in `used_`, and their target's in `below_`.
template <class Use>
void BlockCholesky::each_product(size_t k, Use use) const {
    for (size_t q = first_used_[k]; q < first_used_[k + 1]; q++) {
        // both columns are in the order of elimination
        size_t target = first_[at(place_[at(used_[q].node)])];
        use(q, q, target);
        for (size_t p = q + 1; p < first_used_[k + 1]; p++, target++) {
            while (below_[target].node != used_[p].node) target++;
            use(p, q, target);
        }
    }
}

// Lists the blocks of nodes that are not idle, without fill that only idle nodes would cause.
void BlockCholesky::list_used() {
    const size_t n = order_.size();
    std::vector<char> filled(below_.size(), 0);
    used_.clear();
    first_used_.assign(1, 0);
    for (size_t k = 0; k < n; k++) {
        for (size_t p = first_[k]; p < first_[k + 1] && !idle(order_[k]); p++) {
            if (!idle(below_[p].node) && (filled[p] || !below_[p].filled)) used_.push_back(below_[p]);
        }
        first_used_.push_back(used_.size());
        each_product(k, [&](size_t p, size_t q, size_t target) { if (p != q) filled[target] = 1; });
    }
    list_updates();
    std::fill(changed_.begin(), changed_.end(), 1);
    listed_ = true;
}

// Products of the used blocks of every column, by the column to which they contribute.
void BlockCholesky::list_updates() {
    const size_t n = order_.size();
    first_update_.assign(n + 1, 0);
    for (size_t k = 0; k < n; k++) {
        for (size_t q = first_used_[k]; q < first_used_[k + 1]; q++) first_update_[at(place_[at(used_[q].node)]) + 1] += first_used_[k + 1] - q;
    }
    for (size_t k = 0; k < n; k++) first_update_[k + 1] += first_update_[k];
    update_.resize(first_update_.back());
    std::vector<size_t> next(first_update_.begin(), first_update_.end() - 1);
    for (size_t k = 0; k < n; k++) {
        each_product(k, [&](size_t p, size_t q, size_t target) {
            const Entry &a = used_[p], &b = used_[q];
            update_[next[at(place_[at(b.node)])]++] = {p == q ? diagonal_[at(b.node)] : below_[target].block, a.block, b.block,
                                                       size_[at(a.node)], size_[at(order_[k])]};
        });
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

void BlockCholesky::renew() {
    std::fill(changed_.begin(), changed_.end(), 1);
}

void BlockCholesky::set_root(int node, const double* root) {
    const int n = laws_[at(node)] * laws_[at(node)];
    double* own = &root_[at(node) * most_laws * most_laws];
    if (std::equal(root, root + n, own)) return;
    std::copy(root, root + n, own);
    changed_[at(node)] = 1;
    const bool idle = held_[at(node)] == 0 && std::all_of(root, root + n, [](double r) { return r == 0; });
    listed_ = listed_ && idle == this->idle(node);
    idle_[at(node)] = idle;
}

void BlockCholesky::factor(const std::vector<char>& redundant) {
    if (!listed_) list_used();
    for (size_t k = 0; k < order_.size(); k++) {
        if (!changed_[at(order_[k])] || idle(order_[k])) continue;
        pause();
        factor_column(k, redundant);
        for (size_t p = first_used_[k]; p < first_used_[k + 1]; p++) changed_[at(used_[p].node)] = 1;
    }
    std::fill(changed_.begin(), changed_.end(), 0);
}

// Factorises a column from that of A, all columns before it being done.
void BlockCholesky::factor_column(size_t k, const std::vector<char>& redundant) {
    const int node = order_[k], n = size_[at(node)], held = held_[at(node)];
    const size_t begin = diagonal_[at(node)];
    std::copy_n(&values_[begin], n * n, &factor_[begin]);
    for (size_t p = first_used_[k]; p < first_used_[k + 1]; p++) {
        std::copy_n(&values_[used_[p].block], size_[at(used_[p].node)] * n, &factor_[used_[p].block]);
    }
    for (size_t p = first_update_[k]; p < first_update_[k + 1]; p++) {
        const Update& u = update_[p];
        double *target = &factor_[u.target], *a = &factor_[u.a], *b = &factor_[u.b];
        blocks_.subtract_product(target, a, b, u.rows_a, n, u.inner);
    }
    double *lower = &factor_[begin], *reciprocal = &inverse_[at(start_[at(node)])];
    const double* root = &root_[at(node) * most_laws * most_laws];
    blocks_.factor_diagonal(lower, reciprocal, &values_[begin], root, &redundant[at(start_[at(node)])], rows_of(node));
    for (size_t p = first_used_[k]; p < first_used_[k + 1]; p++) {
        double* b = &factor_[used_[p].block];
        blocks_.solve_rows(b, lower, reciprocal, held, size_[at(used_[p].node)], n);
    }
}

void BlockCholesky::solve(double* x) const {
    for (size_t k = 0; k < order_.size(); k++) {
        const int node = order_[k], n = size_[at(node)];
        double* own = x + start_[at(node)];
        if (idle(node)) {
            std::fill(own, own + n, 0.0);
            continue;
        }
        blocks_.forward(own, &factor_[diagonal_[at(node)]], &inverse_[at(start_[at(node)])], rows_of(node));
        for (size_t p = first_used_[k]; p < first_used_[k + 1]; p++) {
            double* other = x + start_[at(used_[p].node)];
            blocks_.carry_forward(other, &factor_[used_[p].block], own, size_[at(used_[p].node)], n);
        }
    }
    for (size_t k = order_.size(); k-- > 0;) {
        const int node = order_[k], n = size_[at(node)];
        if (idle(node)) continue;
        double* own = x + start_[at(node)];
        for (size_t p = first_used_[k]; p < first_used_[k + 1]; p++) {
            const double* other = x + start_[at(used_[p].node)];
            blocks_.carry_back(own, &factor_[used_[p].block], other, size_[at(used_[p].node)], n);
        }
        blocks_.backward(own, &factor_[diagonal_[at(node)]], &inverse_[at(start_[at(node)])], rows_of(node));
    }
}

}  // namespace crumple::spatial
