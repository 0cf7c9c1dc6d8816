// C0 triangle: constant strain and curvature, transverse shear from its three edges.
//
// The shear at the centroid is that of the lowest-order edge functions, sum over edges of s_ij (grad N_j - grad N_i) / 3; with the mean
// rotation instead, as in a collapsed quadrilateral, pure bending would cause shear.  Theory: docs/theory/shell_triangle.md.
#pragma once
#include "shell/element/edge_shear.hpp"

namespace crumple::shell {
namespace {

// Edges 1-2, 2-3, 3-1: difference of the gradients of the shape functions of their end nodes, divided by 3 [1/m].
struct TriangleEdges {
    Vec g12, g23, g31;
};

CRUMPLE_INLINE TriangleEdges triangle_edges(const Frame& f) {
    const double third = 1.0 / 3.0;
    const Vec b1 = third * (f.bx1 * f.e1 + f.by1 * f.e2), b2 = third * (f.bx2 * f.e1 + f.by2 * f.e2), b3 = Vec{} - b1 - b2;
    return {b2 - b1, b3 - b2, b1 - b3};
}

CRUMPLE_INLINE Vec triangle_shear(const Frame& f, const TriangleEdges& e, const Corners& c) {
    return edge_rate(c, 0, 1, f.e3) * e.g12 + edge_rate(c, 1, 2, f.e3) * e.g23 + edge_rate(c, 2, 0, f.e3) * e.g31;
}

CRUMPLE_INLINE void add_triangle_shear(const Frame& f, const TriangleEdges& e, const Vec (&x)[4], Vec shear, CornerForces& out) {
    add_edge_force(out, x, 0, 1, f.e3, dot(e.g12, shear));
    add_edge_force(out, x, 1, 2, f.e3, dot(e.g23, shear));
    add_edge_force(out, x, 2, 0, f.e3, dot(e.g31, shear));
}

// Largest squared frequency [1/s2]; `wave` holds 3 c^2: each corner has a third of the mass.
CRUMPLE_INLINE Real triangle_frequency(const Frame& f, Real wave) {
    const Real x3 = f.bx1 + f.bx2, y3 = f.by1 + f.by2;
    const Real xx = f.bx1 * f.bx1 + f.bx2 * f.bx2 + x3 * x3, yy = f.by1 * f.by1 + f.by2 * f.by2 + y3 * y3;
    const Real xy = f.bx1 * f.by1 + f.bx2 * f.by2 + x3 * y3;
    return wave * (larger(xx, yy) + magnitude(xy));
}

}  // namespace
}  // namespace crumple::shell
