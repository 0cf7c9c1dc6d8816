// Value, gradient and curvature of the g of a section's interaction surface.
#pragma once

#include <cmath>

#include "spatial/hinge/surface.hpp"

namespace crumple::spatial {

// What is asked of g at a point: itself, also its gradient, and also its curvature.
enum class Order { value, gradient, curvature };

struct GaugeAt {
    double g = 0;
    double gradient[most_components] = {};
    double curvature[most_components][most_components] = {};
};

GaugeAt gauge_at(const Surface& s, int n, const double* x, Order order);

inline double dot(int n, const double* a, const double* b) {
    double sum = 0;
    for (int k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}

inline double length(int n, const double* a) { return std::sqrt(dot(n, a, a)); }

}  // namespace crumple::spatial
