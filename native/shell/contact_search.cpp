// Boxes are listed in the cells that they cover, each point looks into its own cell.
#include "contact_search.hpp"

#include <algorithm>
#include <cmath>

namespace crumple::shell {

namespace {

struct Grid {
    double origin[3], inverse;
    long count[3];
    long cell(const double* x) const {
        long index = 0;
        for (int i = 0; i < 3; i++) {
            const long c = std::clamp(long((x[i] - origin[i]) * inverse), 0L, count[i] - 1);
            index = index * count[i] + c;
        }
        return index;
    }
};

Grid grid_over(const std::vector<Box>& boxes) {
    Grid g{};
    double low[3] = {1e300, 1e300, 1e300}, high[3] = {-1e300, -1e300, -1e300}, side = 0.0;
    for (const Box& b : boxes)
        for (int i = 0; i < 3; i++) {
            low[i] = std::min(low[i], b.low[i]);
            high[i] = std::max(high[i], b.high[i]);
            side += b.high[i] - b.low[i];
        }
    double cell = 1.5 * side / (3.0 * double(boxes.size()));
    // at most about eight cells per element, so that a far-flung node cannot exhaust the memory
    for (;;) {
        double cells = 1.0;
        for (int i = 0; i < 3; i++) cells *= std::floor((high[i] - low[i]) / cell) + 1.0;
        if (!(cells > 8.0 * double(boxes.size()) + 64.0)) break;
        cell *= 1.3;
    }
    g.inverse = 1.0 / cell;
    for (int i = 0; i < 3; i++) {
        g.origin[i] = low[i];
        g.count[i] = long((high[i] - low[i]) / cell) + 1;
    }
    return g;
}

template <class Visit> void each_cell(const Grid& g, const Box& b, Visit visit) {
    long from[3], to[3];
    for (int i = 0; i < 3; i++) {
        from[i] = std::clamp(long((b.low[i] - g.origin[i]) * g.inverse), 0L, g.count[i] - 1);
        to[i] = std::clamp(long((b.high[i] - g.origin[i]) * g.inverse), 0L, g.count[i] - 1);
    }
    for (long x = from[0]; x <= to[0]; x++)
        for (long y = from[1]; y <= to[1]; y++)
            for (long z = from[2]; z <= to[2]; z++) visit(std::size_t((x * g.count[1] + y) * g.count[2] + z));
}

bool contains(const Box& b, const double* x) {
    return x[0] >= b.low[0] && x[0] <= b.high[0] && x[1] >= b.low[1] && x[1] <= b.high[1] && x[2] >= b.low[2] && x[2] <= b.high[2];
}

}  // namespace

PairList points_in_boxes(const double* points, int stride, std::size_t count, const std::vector<Box>& boxes,
                         const std::vector<std::uint8_t>& alive) {
    PairList found;
    if (boxes.empty()) return found;
    const Grid grid = grid_over(boxes);
    // boxes by cell, counted and then placed
    std::vector<Index> first(std::size_t(grid.count[0] * grid.count[1] * grid.count[2]) + 1, 0);
    for (std::size_t e = 0; e < boxes.size(); e++)
        if (alive[e]) each_cell(grid, boxes[e], [&](std::size_t c) { first[c + 1]++; });
    for (std::size_t c = 1; c < first.size(); c++) first[c] += first[c - 1];
    std::vector<Index> member(first.back()), next(first.begin(), first.end() - 1);
    for (std::size_t e = 0; e < boxes.size(); e++)
        if (alive[e]) each_cell(grid, boxes[e], [&](std::size_t c) { member[next[c]++] = Index(e); });
    for (std::size_t n = 0; n < count; n++) {
        const double* x = points + std::size_t(stride) * n;
        const std::size_t c = std::size_t(grid.cell(x));
        for (Index k = first[c]; k < first[c + 1]; k++)
            if (contains(boxes[member[k]], x)) found.emplace_back(Index(n), member[k]);
    }
    return found;
}

}  // namespace crumple::shell
