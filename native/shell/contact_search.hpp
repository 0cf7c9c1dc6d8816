// Which points lie in which boxes: a bucket search.
#pragma once
#include <utility>
#include <vector>

#include "model.hpp"

namespace crumple::shell {

struct Box {
    double low[3], high[3];
};

// Box around corners of `nodes`, grown to all sides.
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

// Pairs (point, box) with the point inside; points in order, boxes in the order of their numbers.
using PairList = std::vector<std::pair<Index, Index>>;
PairList points_in_boxes(const double* points, int stride, std::size_t count, const std::vector<Box>& boxes,
                         const std::vector<std::uint8_t>& alive);

}  // namespace crumple::shell
