// Closest point of a quadrilateral: the closest point of the four triangles around its centroid.
#pragma once
#include "common/vectors.hpp"

namespace crumple::shell {

struct Closest {
    Vec3 point;
    double weight[4];                // of the corners, sum 1
    double distance;
    bool inside;                     // in the interior of a face, not on the border of the element
};

struct TrianglePoint {
    double a, b, c;                  // barycentric
};

// By the Voronoi regions of the triangle (vertex, edge, face).
inline TrianglePoint closest_on_triangle(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double v = d1 / (d1 - d3);
        return {1 - v, v, 0};
    }
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double w = d2 / (d2 - d6);
        return {1 - w, 0, w};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double inverse = 1.0 / (va + vb + vc), v = vb * inverse, w = vc * inverse;
    return {1 - v - w, v, w};
}

inline Closest closest_on_quad(Vec3 p, const Vec3 (&x)[4]) {
    const Vec3 centre = 0.25 * ((x[0] + x[1]) + (x[2] + x[3]));
    Closest best{};
    best.distance = 1e300;
    for (int i = 0; i < 4; i++) {
        const int j = (i + 1) % 4;
        const TrianglePoint t = closest_on_triangle(p, x[i], x[j], centre);
        const Vec3 q = t.a * x[i] + t.b * x[j] + t.c * centre;
        const double d = dot(p - q, p - q);
        if (d >= best.distance) continue;
        best.point = q;
        best.distance = d;
        best.inside = t.c > 1e-9;
        for (double& w : best.weight) w = 0.25 * t.c;
        best.weight[i] += t.a;
        best.weight[j] += t.b;
    }
    best.distance = std::sqrt(best.distance);
    return best;
}

}  // namespace crumple::shell
