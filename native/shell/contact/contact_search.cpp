#include "shell/contact/contact_search.hpp"

#include <cmath>

namespace crumple::shell {

PointGrid::PointGrid(const double* points, int stride, std::size_t count, double cell) : number_(count), points_(count) {
    if (count == 0) return;
    auto point = [&](std::size_t n) { return points + std::size_t(stride) * n; };
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300};
    for (std::size_t n = 0; n < count; n++)
        for (int i = 0; i < 3; i++) {
            if (!std::isfinite(point(n)[i])) continue;
            low[i] = std::min(low[i], point(n)[i]);
            high[i] = std::max(high[i], point(n)[i]);
        }
    double size[3];
    for (int i = 0; i < 3; i++) size[i] = std::max(high[i] - low[i], 0.0);
    // at most about eight cells per point, so that a single distant node cannot exhaust the memory
    for (;; cell *= 1.3) {
        double cells = 1.0;
        for (int i = 0; i < 3; i++) cells *= std::floor(size[i] / cell) + 1.0;
        if (!(cells > 8.0 * double(count) + 64.0)) break;
    }
    inverse_ = 1.0 / cell;
    for (int i = 0; i < 3; i++) {
        origin_[i] = low[i];
        count_[i] = std::int64_t(size[i] / cell) + 1;
    }
    // counting sort of the points by cell
    std::vector<Index> cell_of(count);
    first_.assign(std::size_t(count_[0] * count_[1] * count_[2]) + 1, 0);
    for (std::size_t n = 0; n < count; n++) {
        const double* x = point(n);
        cell_of[n] = Index((along(0, x[0]) * count_[1] + along(1, x[1])) * count_[2] + along(2, x[2]));
        first_[cell_of[n] + 1]++;
    }
    for (std::size_t c = 1; c < first_.size(); c++) first_[c] += first_[c - 1];
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    for (std::size_t n = 0; n < count; n++) {
        const Index place = next[cell_of[n]]++;
        number_[place] = Index(n);
        points_[place] = read3(point(n));
    }
}

}  // namespace crumple::shell
