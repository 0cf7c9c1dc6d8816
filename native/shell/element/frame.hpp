// Co-rotational frame and one-point gradient of a quadrilateral (a triangle repeats its third corner).
//
// e3 is normal to both diagonals, e1 bisects the angle between one midline and the normal of the other, so that the frame rotates
// with the material.  A frame tied to a side would rotate by twice the spin of a shear wave along that side, which makes the
// stiffness under shear stress markedly unsymmetric, and short waves would grow.  In this frame the corners are
// x_I = mean + in-plane part, height z_I = z0 (+1, -1, +1, -1); a warped element has z0 != 0.
// Gradients: d/dx = b_x . v with b_x = (y24, y31, y42, y13) / 2A, so B3 = -B1 and B4 = -B2.
#pragma once
#include "shell/simd/pack.hpp"

namespace crumple::shell {
namespace {

struct Frame {
    Vec e1, e2, e3;
    Real area, inverse_area;
    Real bx1, bx2, by1, by2;     // [1/m]
    Real hx, hy, hz;             // sum over corners of (+1, -1, +1, -1) times position [m]; hz = 4 z0
};

// A corner field reduced to what one-point integration uses: differences along the diagonals, and the alternating sum.
struct Pattern {
    Vec along_13, along_24, alternating;
};

CRUMPLE_INLINE Pattern pattern(const Vec (&v)[4]) {
    return {v[0] - v[2], v[1] - v[3], (v[0] + v[2]) - (v[1] + v[3])};
}

CRUMPLE_INLINE Frame frame_of(const Vec (&x)[4]) {
    Frame f;
    const Vec d31 = x[2] - x[0], d42 = x[3] - x[1], normal = cross(d31, d42);
    const Real twice_area = root(dot(normal, normal)), inverse = 1.0 / twice_area;
    f.e3 = inverse * normal;
    f.area = 0.5 * twice_area;
    f.inverse_area = 2.0 * inverse;
    // the midlines lie in the plane; the mean of their rotations is the spin of the material
    const Vec g1 = d31 - d42, g2 = d31 + d42;
    const Vec both = root(dot(g2, g2)) * g1 + root(dot(g1, g1)) * cross(g2, f.e3);
    f.e1 = (1.0 / root(dot(both, both))) * both;
    f.e2 = cross(f.e3, f.e1);
    f.bx1 = -dot(d42, f.e2) * inverse;
    f.bx2 = dot(d31, f.e2) * inverse;
    f.by1 = dot(d42, f.e1) * inverse;
    f.by2 = -dot(d31, f.e1) * inverse;
    const Vec h = (x[0] + x[2]) - (x[1] + x[3]);
    f.hx = dot(h, f.e1);
    f.hy = dot(h, f.e2);
    f.hz = dot(h, f.e3);
    return f;
}

struct Gradient {
    Real x, y, hourglass;        // d/dx, d/dy, and the part orthogonal to linear fields
};

CRUMPLE_INLINE Gradient gradient(const Frame& f, const Pattern& p, Vec e) {
    const Real a = dot(p.along_13, e), b = dot(p.along_24, e);
    const Real gx = f.bx1 * a + f.bx2 * b, gy = f.by1 * a + f.by2 * b;
    return {gx, gy, dot(p.alternating, e) - f.hx * gx - f.hy * gy};
}

// A corner that moves across the diagonal between its neighbours inverts the element: |h . b|, the variation of the area from corner
// to corner, then passes 1.  At 3 it has gone half the way from there to the opposite corner, which is not a physical shape.
constexpr double turned_over = 3.0;

CRUMPLE_INLINE Mask inverted(const Frame& f) {
    const Real first = magnitude(f.hx * f.bx1 + f.hy * f.by1), second = magnitude(f.hx * f.bx2 + f.hy * f.by2);
    return larger(first, second) > turned_over;
}

// Largest squared frequency [1/s2] of membrane waves; `wave` holds 4 c^2.
// Row sums bound the eigenvalue of sum(b b^T): exact for rectangles, safe for skewed shapes.
CRUMPLE_INLINE Real frequency(const Frame& f, Real wave) {
    const Real xx = 2.0 * (f.bx1 * f.bx1 + f.bx2 * f.bx2), yy = 2.0 * (f.by1 * f.by1 + f.by2 * f.by2);
    const Real xy = 2.0 * (f.bx1 * f.by1 + f.bx2 * f.by2);
    return wave * (larger(xx, yy) + magnitude(xy));
}

}  // namespace
}  // namespace crumple::shell
