#include "spatial/contact/friction_limits.hpp"

#include <algorithm>

namespace crumple::spatial {

namespace {

// Number of contacts up to which their coupling is estimated; the states of a run keep its square.
constexpr size_t most_coupled = 32;
// Least s^T H y over s^T s for which H is improved: a smaller one shows a kink, where a contact begins to slide or opens.
constexpr double least_fall = 0.2;

}  // namespace

void FrictionLimits::repeat_plainly() {
    const size_t n = key_.size();
    inverse_.assign(n * n, 0.0);
    for (size_t i = 0; i < n; i++) inverse_[i * n + i] = -1;
}

void FrictionLimits::begin(const std::vector<int64_t>& key, const LimitSlopes& known) {
    passed_ = false;
    key_ = key;
    if (key.size() > most_coupled) return;
    repeat_plainly();
    const size_t n = key.size(), m = known.key.size();
    std::vector<size_t> place(n, m);
    for (size_t i = 0; i < n; i++) {
        const auto at = std::lower_bound(known.key.begin(), known.key.end(), key[i]);
        if (at != known.key.end() && *at == key[i]) place[i] = static_cast<size_t>(at - known.key.begin());
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            if (place[i] < m && place[j] < m) inverse_[i * n + j] = known.inverse[place[i] * m + place[j]];
        }
    }
}

void FrictionLimits::improve(const std::vector<double>& used, const std::vector<double>& error) {
    const size_t n = used.size();
    change_.assign(n, 0.0);
    forward_.assign(n, 0.0);
    back_.assign(n, 0.0);
    double square = 0, along = 0;
    for (size_t i = 0; i < n; i++) {
        change_[i] = used[i] - used_[i];
        square += change_[i] * change_[i];
    }
    if (square == 0) return;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            forward_[i] += inverse_[i * n + j] * (error[j] - error_[j]);
            back_[j] += inverse_[i * n + j] * change_[i];
        }
        along += change_[i] * forward_[i];
    }
    if (!(along > least_fall * square)) return repeat_plainly();
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) inverse_[i * n + j] += (change_[i] - forward_[i]) * back_[j] / along;
    }
}

void FrictionLimits::follow(std::vector<double>& normal, const std::vector<double>& found) {
    const size_t n = normal.size();
    if (n > most_coupled) {
        normal = found;
        return;
    }
    const std::vector<double> used = normal;
    std::vector<double> error(n);
    for (size_t i = 0; i < n; i++) error[i] = found[i] - used[i];
    if (passed_) improve(used, error);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) normal[i] -= inverse_[i * n + j] * error[j];
        normal[i] = std::max(normal[i], 0.0);
    }
    used_ = used;
    error_ = error;
    passed_ = true;
}

LimitSlopes FrictionLimits::slopes() const { return key_.size() > most_coupled ? LimitSlopes{} : LimitSlopes{key_, inverse_}; }

}  // namespace crumple::spatial
