// Bucket search: finds the points that lie in a box.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "shell/run/model.hpp"

namespace crumple::shell {

struct Box {
    double low[3], high[3];
    bool contains(Vec3 x) const {
        return x.x >= low[0] && x.x <= high[0] && x.y >= low[1] && x.y <= high[1] && x.z >= low[2] && x.z <= high[2];
    }
};

// Bounding box of nodes, enlarged by `grow` on all sides.
template <std::size_t corners> Box box_around(const double* position, int stride, const Index* nodes, double grow) {
    Box b;
    for (std::size_t i = 0; i < 3; i++) {
        b.low[i] = 1e300;
        b.high[i] = -1e300;
        for (std::size_t c = 0; c < corners; c++) {
            const double x = position[std::size_t(stride) * nodes[c] + i];
            b.low[i] = x < b.low[i] ? x : b.low[i];
            b.high[i] = x > b.high[i] ? x : b.high[i];
        }
        b.low[i] -= grow;
        b.high[i] += grow;
    }
    return b;
}

// Points sorted into the cells of a grid; several threads may query a grid at the same time.
class PointGrid {
public:
    PointGrid() = default;
    // Cells of edge length `cell` [m], or larger if there would be too many.
    PointGrid(const double* points, int stride, std::size_t count, double cell);

    // Calls visit(point) for the points in the box, in the order of the cells.
    template <class Visit> void each_in(const Box& box, Visit visit) const {
        std::int64_t from[3], to[3];
        for (int i = 0; i < 3; i++) {
            from[i] = along(i, box.low[i]);
            to[i] = along(i, box.high[i]);
        }
        for (std::int64_t x = from[0]; x <= to[0]; x++)
            for (std::int64_t y = from[1]; y <= to[1]; y++) {
                // cells along z are contiguous, and so are their points
                const std::int64_t row = (x * count_[1] + y) * count_[2];
                for (Index k = first_[std::size_t(row + from[2])]; k < first_[std::size_t(row + to[2]) + 1]; k++)
                    if (box.contains(points_[k])) visit(number_[k]);
            }
    }

private:
    std::int64_t along(int axis, double x) const {
        const double cell = (x - origin_[axis]) * inverse_;
        // NaN goes to the first cell
        return cell > 0.0 ? std::int64_t(std::min(cell, double(count_[axis] - 1))) : 0;
    }

    double origin_[3] = {0.0, 0.0, 0.0}, inverse_ = 0.0;
    std::int64_t count_[3] = {1, 1, 1};
    std::vector<Index> first_{0, 0};             // [cell]; one more entry
    std::vector<Index> number_;                  // indices of the points by cell, increasing within each
    std::vector<Vec3> points_;                   // positions in the same order
};

}  // namespace crumple::shell
